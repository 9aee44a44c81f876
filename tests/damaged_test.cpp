// Damaged files, made by mutation from fixed seeds: cut off, also at every byte, bytes and bits flipped, huge counts, blocks repeated, exchanged or left
// out, brackets nested deep, runs of one byte, numbers out of range.
// Whatever reads them ends with an exit code of its own: no signal, at most 1 GiB, 2 seconds. ISOPARM_DAMAGED=N makes N of each kind and
// command instead of a few: tests/long/damaged.sh.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <random>

#include "error.h"
#include "expect_program.h"
#include "image/image_header.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;
using test::read_all, test::run, test::write_all;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kSeconds = 60, kMebibytes = 1e9;  // sanitizers take ten times the time, and memory of their own
#else
constexpr double kSeconds = 2, kMebibytes = 1024;
#endif

std::string damaged(std::string bytes, std::mt19937& random, bool text) {
    const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
    const std::size_t kind = below(9), times = below(3) + 1;
    for (std::size_t i = 0; i < times && bytes.size() > 8; ++i) {
        const std::size_t at = below(bytes.size()), length = std::min(below(64) + 1, bytes.size() - at);
        if (kind == 0) bytes.resize(at);
        else if (kind == 1) bytes[at] = static_cast<char>(random());
        else if (kind == 2) bytes[at % 200] = static_cast<char>(bytes[at % 200] ^ 1 << below(8));
        else if (kind == 3) {
            static const std::string counts[] = {{'\xff', '\xff', '\xff', '\xff'}, {'\xff', '\xff', '\xff', '\x7f'}, {0, 0, 0, '\x80'}, {0, 0, 0, 0}, {'\x40', 0, 0, 0}};
            bytes.replace(at % 300 % (bytes.size() - 4), 4, counts[below(5)]);
        } else if (kind == 4) bytes.insert(at, bytes.substr(at, length));
        else if (kind == 5) bytes.erase(at, length);
        else if (kind == 7) {  // two blocks change places
            const std::size_t a = below(bytes.size() / 2), b = bytes.size() / 2 + below(bytes.size() / 2), n = std::min(length, bytes.size() - b);
            std::swap_ranges(bytes.begin() + static_cast<std::ptrdiff_t>(a), bytes.begin() + static_cast<std::ptrdiff_t>(std::min(a + n, b)), bytes.begin() + static_cast<std::ptrdiff_t>(b));
        } else if (kind == 8) {
            static const std::string runs[] = {"[", "{\"a\":", "(", "-", "1", " ", "\n", std::string(1, '\0'), "\xff"};
            const std::string& unit = runs[below(text ? 7 : 9)];
            std::string run;
            for (const std::size_t n = 1 + below(20000); run.size() < n;) run += unit;
            bytes.insert(at, run);
        }
        else if (const std::size_t digit = text ? bytes.find_first_of("0123456789", at) : std::string::npos; digit != std::string::npos) {
            static const char* const numbers[] = {"99999999999", "1e308", "-1", "1e-320", "nan", "0", "inf", "4294967296", "2147483647"};
            bytes.replace(digit, 1, numbers[below(9)]);
        } else bytes[at] = '\xff';
    }
    return bytes;
}

struct Measured {
    int code;  // 128 + a signal's number
    double seconds, mebibytes;
    std::string err;
};
Measured measured(const std::string& folder, const std::string& arguments) {
    const std::string command = "cd '" + folder + "' && ulimit -c 0 && exec '" + test::program() + "' " + arguments + " --threads 1 >/dev/null 2>err </dev/null";
    const pid_t id = ::fork();
    if (id == 0) {
        ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
        ::_exit(127);
    }
    int status = 0;
    rusage used{};
    ::wait4(id, &status, 0, &used);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), seconds(used.ru_utime) + seconds(used.ru_stime), static_cast<double>(used.ru_maxrss) / 1024, read_all(folder + "/err")};
}

struct Kind {
    std::string file, arguments;  // FILE is the damaged one; file.json names damaged.bv
    bool text;
    int few;
};

/// Each test has a process of its own in ctest: it makes only what it needs.
class Damaged : public testing::TestWithParam<Kind> {
protected:
    void SetUp() override {
        const std::string& in = folder.path();
        const fs::path source = test::source_folder();
        fs::copy_file(source / "scenes/coons.json", in + "/coons.json");
        fs::copy_file(source / "scenes/teapot.bv", in + "/teapot.bv");
        fs::copy_file(source / "tests/data/cages/semisharp.obj", in + "/cage.obj");
        for (const std::string name : {"curves.brep", "loop.lop"}) fs::copy_file(source / "tests/fuzz/corpus" / name, in + "/" + name);
        for (const std::string type : {"brep", "lop"}) write_all(in + "/" + type + ".json", R"({"isoparm": 1, "curves": {"c": {"type": "file", "path": "damaged.)" + type + R"(", "index": 1}}})");
        write_all(in + "/file.json", R"({"isoparm": 1, "surfaces": {"s": {"type": "file", "path": "damaged.bv"}}, "objects": [{"surface": "s"}], "tessellation": {"tolerance": 0.1}})");
        const std::string& file = GetParam().file;
        if (file[0] == 'a') {
            ASSERT_EQ(run("render coons.json --size 24x16 --samples 1 --quiet -o " + file, in).code, 0);
        }
        if (file[0] == 'm') {
            ASSERT_EQ(run("tessellate coons.json --tolerance 0.02 --quiet -o " + file, in).code, 0);
        }
        if (file == "c.json") {
            ASSERT_EQ(run("tessellate coons.json --tolerance 0.02 --quiet -o m.ply --certificate c.json", in).code, 0);
        }
    }

    /// Tries each file; what fails is kept.
    template <class Make> void try_all(int count, const char* how, Make make) {
        const Kind& kind = GetParam();
        const std::string name = "damaged" + fs::path(kind.file).extension().string();
        std::string arguments = kind.arguments;
        if (const auto at = arguments.find("FILE"); at != std::string::npos) arguments.replace(at, 4, name);
        double seconds = 0, mebibytes = 0;
        for (int k = 0; k < count; ++k) {
            const std::string bytes = make(k);
            write_all(folder / name, bytes);
            const Measured m = measured(folder.path(), arguments);
            seconds = std::max(seconds, m.seconds), mebibytes = std::max(mebibytes, m.mebibytes);
            const std::string what = kind.file + ", " + how + " " + std::to_string(k) + ", " + arguments + ": " + m.err;
            EXPECT_TRUE(m.code <= 4 || m.code == 65) << m.code << " " << what;
            EXPECT_TRUE((m.code != 4 && m.code != 65) || m.err.find("isoparm: ") != std::string::npos) << what;
            EXPECT_LE(m.seconds, kSeconds) << what;
            EXPECT_LE(m.mebibytes, kMebibytes) << what;
            if (HasFailure()) {
                const std::string kept = (fs::temp_directory_path() / ("isoparm-" + std::to_string(k) + "-" + name)).string();
                write_all(kept, bytes);
                FAIL() << "the file is kept: " << kept;
            }
        }
        if (std::getenv("ISOPARM_DAMAGED")) std::printf("%-11s %5d files (%s), at most %.2f s, %.0f MiB: %s\n", kind.file.c_str(), count, how, seconds, mebibytes, kind.arguments.c_str());
    }
    const test::TemporaryFolder folder{};
};

/// As many as the environment says, or a few.
int count_of(int few) {
    const char* given = std::getenv("ISOPARM_DAMAGED");
    return given ? std::atoi(given) : few;
}

TEST_P(Damaged, EndsWithAnExitCode) {
    const std::string good = read_all(folder / GetParam().file);
    ASSERT_FALSE(good.empty());
    try_all(count_of(GetParam().few), "seed", [&](int k) {
        std::mt19937 random(static_cast<unsigned>(k + 1));
        return damaged(good, random, GetParam().text);
    });
    // Cut off at every byte of small files, and at the first and last bytes of others; only where many are asked for.
    const int size = static_cast<int>(good.size()), count = std::min({size, 4 * count_of(0), 1000});
    try_all(count, "cut", [&](int k) { return good.substr(0, static_cast<std::size_t>(k < count / 2 ? k : size - count + k)); });
}
INSTANTIATE_TEST_SUITE_P(Files, Damaged,
                         testing::Values(Kind{"a.exr", "diff a.exr FILE -q", false, 2}, Kind{"a.png", "diff a.png FILE -q --html page.html", false, 2}, Kind{"a.jpg", "diff a.jpg FILE -q", false, 1},
                                         Kind{"a.tif", "diff a.tif FILE -q", false, 1}, Kind{"a.tga", "diff a.tga FILE -q", false, 1}, Kind{"a.bmp", "diff FILE a.bmp -q", false, 1},
                                         Kind{"m.ply", "verify FILE --against coons.json", false, 8}, Kind{"m.obj", "verify FILE --against coons.json", true, 8}, Kind{"m.stl", "verify FILE --against coons.json", false, 8},
                                         Kind{"m.glb", "verify FILE --against coons.json", false, 12}, Kind{"curves.brep", "info brep.json", true, 20}, Kind{"loop.lop", "info lop.json", true, 12},
                                         Kind{"cage.obj", "limit FILE", true, 20}, Kind{"teapot.bv", "tessellate file.json -o o.ply --max-triangles 5000 --quiet", true, 20}, Kind{"coons.json", "info FILE", true, 20},
                                         Kind{"coons.json", "tessellate FILE -o o.ply --max-triangles 5000 --quiet", true, 20}, Kind{"coons.json", "check FILE", true, 8},
                                         Kind{"coons.json", "render FILE -o o.png --size 24x16 --samples 1 --quiet", true, 2}, Kind{"c.json", "verify m.ply --certificate FILE --against coons.json", true, 20}),
                         [](const auto& info) { return std::to_string(info.index) + "_" + fs::path(info.param.file).extension().string().substr(1); });

TEST(DamagedImages, CutOffAreNeverEqual) {
    const test::TemporaryFolder t;
    for (const std::string type : {"png", "jpg", "tif", "tga"}) {
        const std::string good = t / ("a." + type), cut = t / ("b." + type);
        ASSERT_EQ(run("render " + test::scene("coons") + " --size 16x16 --samples 1 --quiet -o " + good).code, 0);
        const std::string bytes = read_all(good);
        const auto look_at = [&](std::size_t size) {
            const std::string_view there = std::string_view(bytes).substr(0, size);
            check_image_end(read_image_header(there, size, good).format, size, [&](std::uint64_t at, std::size_t n) { return std::string(at < size ? there.substr(at, n) : ""); }, good);
        };
        look_at(bytes.size());
        const std::size_t old = type == "tga" ? 18 + 16 * 16 * 3 : 0;  // without a footer, but with all pixels: a file of the format's first version
        for (std::size_t size = 0; size < bytes.size(); ++size)
            if (size != old || old == 0) EXPECT_THROW(look_at(size), Error) << type << " " << size;
        if (type == "jpg") continue;
        write_all(cut, bytes.substr(0, bytes.size() - 1));
        test::expect("diff " + good + " " + cut, 4, "damaged or cut off");
    }
}
TEST(DamagedMeshes, SurplusBytesAreTold) {
    const test::TemporaryFolder t;
    ASSERT_EQ(run("tessellate " + test::scene("coons") + " --tolerance 0.02 --quiet -o " + t / "a.ply").code, 0);
    const std::string verify = "verify " + t / "a.ply" + " --against " + test::scene("coons");
    write_all(t / "a.ply", read_all(t / "a.ply") + "\n");
    EXPECT_EQ(run(verify).code, 0) << "a blank at the end is no harm";
    write_all(t / "a.ply", read_all(t / "a.ply") + "more");
    test::expect(verify, 65, "bytes after the last element, expected the end of the file");
}
TEST(DamagedCertificates, NameWhatTheSceneDoesNotHave) {
    const test::TemporaryFolder t;
    ASSERT_EQ(run("tessellate " + test::scene("coons") + " --surface S --tolerance 0.02 --quiet -o " + t / "a.ply --certificate " + t / "c.json").code, 0);
    std::string text = read_all(t / "c.json");
    text.replace(text.find("\"surface\": \"S\""), 14, "\"surface\": \"other\"");
    write_all(t / "c.json", text);
    test::expect("verify --certificate " + t / "c.json --against " + test::scene("coons"), 65, "names what");
}
TEST(DamagedFolders, MissingImagesAreInTheReports) {
    const test::TemporaryFolder t;
    write_all(t / "a.png", "");
    test::expect("diff " + t / "a.png " + t / "none.png --junit -", 4, "none.png: there is no such file or folder\"/>");
    test::expect("diff " + t.path() + " " + t / "none --json", 4, "{\"result\": \"error\"");
}

}  // namespace
}  // namespace isoparm
