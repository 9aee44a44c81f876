// Faults at run time, over every command that writes a file: calls of the C library that fail (tests/faults/faults.cpp), full and
// read-only disks, no memory, kill -9, many runs at once. Each run ends with a whole result, or with an exit code, a message, the old
// file and no other. Not with sanitizers, which have their own malloc and reserve terabytes of addresses.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "expect_program.h"
#include "image/image.h"

#ifdef ISOPARM_FAULTS

namespace isoparm {
namespace {

namespace fs = std::filesystem;
using test::Outcome, test::read_all, test::run, test::scene, test::write_all;
using Files = std::map<std::string, std::string>;

/// in/ has what is read, out/ is written to: name -> bytes.
class Faults : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directory(t / "in"), fs::create_directory(t / "out");
        fs::copy_file(test::source_folder() + "/scenes/coons.json", t / "in/coons.json");
        fs::copy_file(test::source_folder() + "/tests/data/cages/plane.obj", t / "in/plane.obj");
    }
    void make_pictures() const {
        Image image{16, 16, std::vector<float>(16 * 16 * 4, 1.0f)};
        for (const char* name : {"in/a.png", "in/a.exr"}) write_image(t / name, image, {});
        for (std::size_t i = 0; i < 256; ++i) image.pixels[4 * i] = static_cast<float>(i) / 256;
        for (const char* name : {"in/b.png", "in/b.exr"}) write_image(t / name, image, {});
    }
    Files files() const {
        Files all;
        for (const auto& f : fs::recursive_directory_iterator(t / "out"))
            if (f.is_regular_file()) all[fs::relative(f.path(), t / "out").string()] = read_all(f.path().string());
        return all;
    }
    void restore(const Files& old) const {
        fs::remove_all(t / "out");
        fs::create_directory(t / "out");
        for (const auto& [name, text] : old) write_all(t / ("out/" + name), text);
    }
    Outcome isoparm(const std::string& arguments, const std::string& before = "") const { return run(arguments + " --threads 2 --quiet", t.path(), before); }

    /// Success with `whole`, or an exit code, a message and `old`; in any case nothing else. Several outputs appear one after the other.
    void expect_whole_or_old(const Outcome& o, const Files& old, const Files& whole, const std::string& what) const {
        const bool done = o.code <= 2 && o.err.empty();
        EXPECT_TRUE(done || !o.err.empty()) << what << ": ended with " << o.code << " and no message";
        EXPECT_TRUE(done || o.code == 4 || o.code == 70) << what << ": " << o.code << " " << o.err;
        for (const auto& [name, text] : files()) {
            const bool is_old = old.count(name) > 0 && old.at(name) == text, is_new = whole.count(name) > 0 && whole.at(name) == text;
            EXPECT_TRUE(is_new || (is_old && !done)) << what << ": " << name << " is neither the old nor the new file; " << o.err;
        }
        for (const auto& [name, text] : old) EXPECT_TRUE(fs::exists(t / ("out/" + name))) << what << ": " << name << " is gone";
    }
    /// Makes each call fail in turn, up to the `most`-th; the number of faults.
    int inject(const std::string& arguments, const std::string& kind, int most, const Files& old, const Files& whole) const {
        int faults = 0;
        for (int n = 1; n <= most; ++n) {
            restore(old);
            fs::remove(t / "log");
            const Outcome o = isoparm(arguments, "env LD_PRELOAD=" ISOPARM_FAULTS " ISOPARM_FAULT=" + kind + " ISOPARM_FAULT_AT=" + std::to_string(n) + " ISOPARM_FAULT_ONCE=1 ISOPARM_FAULT_LOG=log");
            if (!fs::exists(t / "log")) break;
            ++faults;
            expect_whole_or_old(o, old, whole, arguments + ", " + kind + " number " + std::to_string(n));
        }
        return faults;
    }
    void expect_survives(const std::string& arguments, const Files& old, int most) const {
        restore(old);
        const Outcome o = isoparm(arguments);
        ASSERT_LE(o.code, 2) << arguments << o.err;
        const Files whole = files();
        ASSERT_NE(old, whole) << arguments;
        for (const char* kind : {"write", "fsync", "rename", "open"}) EXPECT_GT(inject(arguments, kind, most, old, whole), 0) << arguments << ": no call of " << kind << " is made";
    }
    const test::TemporaryFolder t;
};

TEST_F(Faults, OfCallsInMeshes) {
    for (const char* type : {"ply", "obj", "stl", "glb"}) {
        const std::string name = std::string("m.") + type;
        expect_survives("tessellate in/coons.json --tolerance 0.1 -o out/" + name, {{name, "old"}}, 20);
    }
}
/// As of a run in another container or on another host, which draws the same name.
TEST_F(Faults, OfRandomNamesLeaveOthersFiles) {
    const std::string mesh = "tessellate in/coons.json --tolerance 0.1 -o out/m.ply", faults = "env LD_PRELOAD=" ISOPARM_FAULTS " ISOPARM_FAULT_AT=1 ISOPARM_FAULT_LOG=log ISOPARM_FAULT=random ";
    isoparm(mesh);
    Files whole = files(), old{{"m.ply", "old"}};
    whole["isoparm.tmp-0000000000000000"] = old["isoparm.tmp-0000000000000000"] = "of another run";
    restore(old);
    const Outcome always = isoparm(mesh, faults);
    EXPECT_EQ(always.code, 4) << always.err;
    EXPECT_NE(always.err.find("File exists"), std::string::npos) << always.err;
    EXPECT_EQ(files(), old);
    EXPECT_TRUE(fs::exists(t / "log"));
    const Outcome once = isoparm(mesh, faults + "ISOPARM_FAULT_ONCE=1 ");
    EXPECT_EQ(once.code, 0) << once.err;
    EXPECT_EQ(files(), whole);
}
TEST_F(Faults, OfCallsInCertificates) { expect_survives("tessellate in/coons.json --tolerance 0.1 -o out/m.ply --certificate out/c.json", {{"m.ply", "old"}, {"c.json", "old"}}, 20); }
TEST_F(Faults, OfCallsInReports) { expect_survives("limit in/plane.obj -o out", {{"limit.json", "old"}}, 20); }
TEST_F(Faults, OfCallsInPng) { expect_survives("render in/coons.json --size 16x16 --samples 1 -o out/p.png", {{"p.png", "old"}}, 1); }
TEST_F(Faults, OfCallsInJpeg) { expect_survives("render in/coons.json --size 16x16 --samples 1 -o out/p.jpg", {{"p.jpg", "old"}}, 1); }
TEST_F(Faults, OfCallsInDifferences) {
    make_pictures();
    expect_survives("diff in/a.exr in/b.exr -o out/d.exr", {{"d.exr", "old"}}, 1);
}
TEST_F(Faults, OfCallsInPages) {
    make_pictures();
    expect_survives("diff in/a.png in/b.png --junit out/j.xml --html out/h.html", {{"j.xml", "old"}, {"h.html", "old"}}, 1);
}

/// What could not be compared for want of something that is there again is no reason to take the new image for the old one.
TEST_F(Faults, OfReadingKeepReferences) {
    make_pictures();
    fs::create_directories(t / "out/refs"), fs::create_directories(t / "out/news");
    fs::copy_file(t / "in/a.png", t / "out/refs/x.png"), fs::copy_file(t / "in/b.png", t / "out/news/x.png");
    const Files old = files();
    const std::string diff = "diff out/refs out/news --update", fault = "env LD_PRELOAD=" ISOPARM_FAULTS " ISOPARM_FAULT=read ISOPARM_FAULT_AT=1 ISOPARM_FAULT_ONCE=1";
    const Outcome failed = isoparm(diff, fault);
    EXPECT_EQ(failed.code, 4) << failed.err;
    EXPECT_NE(failed.err.find("was not updated"), std::string::npos) << failed.err;
    EXPECT_EQ(files(), old);
    EXPECT_EQ(isoparm(diff).code, 0);
    EXPECT_NE(files(), old);
}

TEST_F(Faults, OfMemoryAreTold) {
    const Files old{{"m.ply", "old"}};
    const std::string mesh = "tessellate in/coons.json --tolerance 0.1 -o out/m.ply";
    isoparm(mesh);
    const Files whole = files();
    for (const char* once : {"", "ISOPARM_FAULT_ONCE=1 "})  // the first ones are those of libraries, before main()
        for (double n = 100; n < 1e5; n *= 1.9) {
            restore(old);
            const Outcome o = isoparm(mesh, "env " + std::string(once) + "LD_PRELOAD=" ISOPARM_FAULTS " ISOPARM_FAULT=malloc ISOPARM_FAULT_AT=" + std::to_string(std::lround(n)));
            if (o.code >= 128) EXPECT_NE(o.err.find("isoparm: crashed"), std::string::npos) << o.err;  // glibc's own: it cannot register what a thread leaves
            else expect_whole_or_old(o, old, whole, once + std::to_string(n));
        }
}
TEST_F(Faults, OfAddressesAreTold) {
    for (const char* arguments : {"tessellate in/coons.json --tolerance 1e-6 -o out/m.ply", "render in/coons.json --size 2000x2000 --samples 1 -o out/p.png"}) {
        int told = 0;
        restore({});
        for (const int mebibytes : {85, 110, 140}) {
            const Outcome o = isoparm(arguments, "ulimit -c 0 && ulimit -v " + std::to_string(mebibytes * 1024) + " &&");
            if (o.code == 0) break;
            EXPECT_FALSE(o.err.empty()) << arguments << " with " << mebibytes << " MiB: " << o.code;
            EXPECT_LT(o.code, 128) << o.err;
            EXPECT_TRUE(files().empty());
            ++told;
        }
        EXPECT_GT(told, 0) << arguments;
    }
}

/// A disk of 64 KiB with an old file, where the test may mount one.
TEST_F(Faults, OfDisks) {
    if (::mount("tmpfs", (t / "out").c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "only root can mount a small disk";
    struct Mounted {
        std::string path;
        ~Mounted() { ::umount2(path.c_str(), MNT_DETACH); }
    } const mounted{t / "out"};
    const std::vector<std::pair<std::string, std::string>> commands{{"m.ply", "tessellate in/coons.json --tolerance 1e-5 -o out/m.ply"},
                                                                    {"m.obj", "tessellate in/coons.json --tolerance 1e-5 -o out/m.obj"},
                                                                    {"p.png", "render in/coons.json --size 400x300 --samples 1 -o out/p.png"},
                                                                    {"p.exr", "render in/coons.json --size 400x300 --samples 1 -o out/p.exr"}};
    const std::string old(30000, 'x');
    const auto check = [&](const std::string& name, const std::string& arguments, const std::string& message) {
        const Outcome o = isoparm(arguments);
        EXPECT_EQ(o.code, 4) << arguments << "\n" << o.err;
        EXPECT_NE(o.err.find(name), std::string::npos) << arguments << "\n" << o.err;
        EXPECT_NE(o.err.find(message), std::string::npos) << arguments << "\n" << o.err;
        EXPECT_EQ(files(), (Files{{name, old}})) << arguments;
    };
    for (const auto& [name, arguments] : commands) {
        for (const auto& [other, ignored] : commands) fs::remove(t / ("out/" + other));
        write_all(t / ("out/" + name), old);
        check(name, arguments, "writ");
        if (name != "m.ply") continue;
        ASSERT_EQ(::mount("", mounted.path.c_str(), "", MS_REMOUNT | MS_RDONLY, "size=64k"), 0);
        check(name, arguments, "Read-only file system");
        ASSERT_EQ(::mount("", mounted.path.c_str(), "", MS_REMOUNT, "size=64k"), 0);
    }
}

TEST_F(Faults, OfKillsLeaveOneFile) {
    const std::string mesh = "tessellate in/coons.json --tolerance 1e-4 -o out/m.obj";
    isoparm(mesh);
    const Files whole = files(), old{{"m.obj", "old"}};
    const int unnamed = ::open((t / "out").c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (unnamed >= 0) ::close(unnamed);
    int killed = 0;
    for (int k = 1; k <= 12; ++k) {
        restore(old);
        killed += isoparm(mesh, "timeout -s KILL 0." + std::to_string(1000 + 7919 * k % 1000).substr(1)).code != 0;
        Files found = files();
        if (unnamed < 0) std::erase_if(found, [](const auto& f) { return f.first.find(".tmp-") != std::string::npos; });
        EXPECT_TRUE(found == old || found == whole) << found.size() << " files, killed at " << k;
    }
    EXPECT_GT(killed, 0);
}
/// As on a file system without O_TMPFILE: the first opening for writing fails, and the temporary has a name from the start.
TEST_F(Faults, OfSignalsRemoveTemporariesWithNames) {
    const std::string mesh = "tessellate in/coons.json --tolerance 1e-4 -o out/m.obj", unnamed_fails = "env LD_PRELOAD=" ISOPARM_FAULTS " ISOPARM_FAULT=open ISOPARM_FAULT_AT=1 ISOPARM_FAULT_ONCE=1 ";
    isoparm(mesh);
    const Files whole = files(), old{{"m.obj", "old"}};
    int stopped = 0;
    for (int k = 1; k <= 12; ++k) {
        restore(old);
        stopped += isoparm(mesh, unnamed_fails + "timeout -s TERM 0." + std::to_string(1000 + 7919 * k % 1000).substr(1)).code != 0;
        const Files found = files();
        EXPECT_TRUE(found == old || found == whole) << found.size() << " files, stopped at " << k;
    }
    EXPECT_GT(stopped, 0);
}
TEST_F(Faults, OfManyRunsToOneFile) {
    const std::string one = "tessellate in/coons.json --tolerance 1e-3 --threads 1 --quiet -o out/m.ply";
    isoparm(one);
    const Files whole = files();
    restore({});
    const Outcome o = run("--version", t.path(), "for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16; do { '" + test::program() + "' " + one + " || echo failed >>out/failed; } & done; wait;");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(files(), whole);
}

}  // namespace
}  // namespace isoparm

#endif
