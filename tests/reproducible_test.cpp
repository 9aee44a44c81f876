// Two runs give the same bytes, under any locale, time zone, thread count and date.
#include <gtest/gtest.h>

#include <filesystem>

#include "expect_program.h"

namespace isoparm {
namespace {

using test::read_all, test::run, test::scene;

class Reproducible : public testing::Test {
protected:
    /// `arguments` write `file`, or standard output if that is empty.
    void expect_same(const std::string& arguments, const std::string& file) const {
        std::string bytes[2];
        const char* const places[] = {"env LC_ALL=C TZ=UTC0 ISOPARM_THREADS=1 SOURCE_DATE_EPOCH=0", "env LC_ALL=de_DE.UTF-8 LANG=de_DE.UTF-8 TZ=XXX-11:45 ISOPARM_THREADS=3 SOURCE_DATE_EPOCH=1700000000"};
        for (int k = 0; k < 2; ++k) {
            const test::Outcome o = run(arguments, t.path(), places[k]);
            EXPECT_LE(o.code, 1) << arguments << "\n" << o.err;
            bytes[k] = file.empty() ? o.out : read_all(t / file);
            if (!file.empty()) std::filesystem::remove(t / file);
        }
        EXPECT_FALSE(bytes[0].empty()) << arguments;
        EXPECT_TRUE(bytes[0] == bytes[1]) << arguments << ": " << bytes[0].size() << " and " << bytes[1].size() << " bytes";
    }
    const test::TemporaryFolder t;
};

TEST_F(Reproducible, Images) {
    for (const char* name : {"p.png", "p.exr"}) expect_same("render " + scene("coons") + " --size 40x30 --samples 4 --quiet -o " + name, name);
    expect_same("render " + scene("coons") + " --size 40x30 --samples 4 --aov N,Z,patch --quiet -o a.exr", "a.exr");
}
TEST_F(Reproducible, Meshes) {
    for (const char* name : {"m.ply", "m.obj", "m.stl", "m.glb"}) expect_same("tessellate " + scene("teapot") + " --tolerance 1e-2rel --quiet -o " + name, name);
    expect_same("tessellate " + scene("coons") + " --tolerance 1e-2 --quiet -o m.ply --certificate c.json", "c.json");
}
TEST_F(Reproducible, Answers) {
    expect_same("info " + scene("coons"), "");
    expect_same("eval " + scene("coons") + " --surface S --at 0.3,0.7 --json", "");
    expect_same("check " + scene("s003_coons_network") + " --json", "");
    expect_same("limit '" + test::source_folder() + "/tests/data/cages/plane.obj' --json", "");
}

}  // namespace
}  // namespace isoparm
