#include "io/mesh_files.h"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/stat.h>

#include <bit>
#include <csignal>
#include <cstring>
#include <sstream>

#include "error.h"
#include "io/atomic_file.h"
#include "run_program.h"

namespace isoparm {
namespace {

using test::read_all;
using test::TemporaryFolder;
using test::write_all;

/// Two triangles, in two parts; coordinates that few digits do not hold.
Mesh two_triangles() {
    Mesh mesh;
    mesh.positions = {{0.1, 1.0 / 3, -0.0}, {1e-300, 2, 0}, {1e17 + 2, 0, 1}, {0.1, 1.0 / 3 + 1e-12, 0}};
    MeshPart a;
    a.name = "left part";
    a.uv.resize(3);
    a.vertex = {0, 1, 2};
    a.triangles = {{0, 1, 2}};
    MeshPart b = a;
    b.name = "right";
    b.vertex = {3, 0, 2};  // collapses in float
    mesh.parts = {a, b};
    return mesh;
}
template <class T> T get(const std::string& bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

TEST(MeshFiles, PlyKeepsEveryBit) {
    const Mesh mesh = two_triangles();
    std::ostringstream out;
    write_ply(out, mesh, "one\ntwo");
    const std::string text = out.str();
    EXPECT_EQ(text.rfind("ply\nformat binary_little_endian 1.0\ncomment one\ncomment two\nelement vertex 4\nproperty double x\n", 0), 0u);
    const std::size_t data = text.find("end_header\n") + 11;
    ASSERT_EQ(text.size(), data + 4 * 24 + 2 * 13);
    for (std::size_t k = 0; k < 4; ++k)
        for (int i = 0; i < 3; ++i) EXPECT_EQ(get<std::uint64_t>(text, data + 24 * k + 8 * i), std::bit_cast<std::uint64_t>(mesh.positions[k][i]));
    EXPECT_EQ(text[data + 96], 3);
    EXPECT_EQ(get<std::int32_t>(text, data + 97 + 8), 2);
    EXPECT_EQ(get<std::int32_t>(text, data + 96 + 13 + 1), 3);  // mesh vertices, not corners
}
TEST(MeshFiles, ObjDecimalsReadBackExactly) {
    const Mesh mesh = two_triangles();
    std::ostringstream out;
    write_obj(out, mesh, "made by a test");
    std::istringstream in(out.str());
    std::string word, line;
    std::getline(in, line);
    EXPECT_EQ(line, "# made by a test");
    for (const Point& p : mesh.positions) {
        in >> word;
        EXPECT_EQ(word, "v");
        for (int i = 0; i < 3; ++i) {
            in >> word;
            EXPECT_EQ(std::strtod(word.c_str(), nullptr), p[i]);
        }
    }
    EXPECT_NE(out.str().find("g left_part\nf 1 2 3\ng right\nf 4 1 3\n"), std::string::npos);
}
TEST(MeshFiles, StlLeavesOutFacetsThatFloatCollapses) {
    std::ostringstream out;
    EXPECT_EQ(write_stl(out, two_triangles()), 1u);
    const std::string text = out.str();
    ASSERT_EQ(text.size(), 84u + 50u);
    EXPECT_NE(text.rfind("solid", 0), 0u);
    EXPECT_EQ(get<std::uint32_t>(text, 80), 1u);
    EXPECT_EQ(get<float>(text, 84 + 12), 0.1f);
}
TEST(MeshFiles, TheExtensionDecides) {
    const TemporaryFolder t;
    for (const char* name : {"m.ply", "m.OBJ", "m.stl"}) {
        write_mesh(t / name, two_triangles(), "c");
        EXPECT_GT(read_all(t / name).size(), 80u);
    }
    try {
        write_mesh(t / "m.xyz", two_triangles(), "c");
        ADD_FAILURE();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::usage);
    }
    EXPECT_EQ(t.files(), 3u);
}

ErrorKind kind_of(const std::function<void()>& work, const std::string& message) {
    try {
        work();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
        return e.kind();
    }
    ADD_FAILURE() << "no error: " << message;
    return ErrorKind::usage;
}

TEST(AtomicFile, AppearsWholeOrNotAtAll) {
    const TemporaryFolder t;
    write_all(t / "a", "old");
    EXPECT_THROW(write_atomically(t / "a", [](std::ostream& out) {
                     out << "half";
                     throw std::runtime_error("stop");
                 }), std::runtime_error);
    EXPECT_EQ(read_all(t / "a"), "old");
    write_atomically(t / "a", [](std::ostream& out) { out << "new"; });
    EXPECT_EQ(read_all(t / "a"), "new");
    EXPECT_EQ(t.files(), 1u);
}
TEST(AtomicFile, KeepsPermissionsAndLinks) {
    const TemporaryFolder t;
    write_all(t / "a", "old");
    ::chmod((t / "a").c_str(), 0640);
    std::filesystem::create_symlink("a", t / "link");
    write_atomically(t / "link", [](std::ostream& out) { out << "new"; });
    EXPECT_TRUE(std::filesystem::is_symlink(t / "link"));
    EXPECT_EQ(read_all(t / "a"), "new");
    struct stat s {};
    ::stat((t / "a").c_str(), &s);
    EXPECT_EQ(s.st_mode & 0777, 0640u);
}
TEST(AtomicFile, DropsSetuid) {
    const TemporaryFolder t;
    write_all(t / "a", "old");
    ASSERT_EQ(::chmod((t / "a").c_str(), 06755), 0);
    write_atomically(t / "a", [](std::ostream& out) { out << "new"; });
    struct stat s {};
    ::stat((t / "a").c_str(), &s);
    EXPECT_EQ(s.st_mode & 07777, 0755u);
}
/// Of a plain user: root may open what the umask forbids.
TEST(AtomicFile, IsWrittenUnderAnyUmask) {
    const TemporaryFolder t;
    ::chmod(t.path().c_str(), 0777);
    for (const mode_t mask : {0222u, 0777u, 0027u}) {
        const pid_t child = ::fork();
        if (child == 0) {
            if (::geteuid() == 0 && (::setgid(65534) != 0 || ::setuid(65534) != 0)) ::_exit(2);
            ::prctl(PR_SET_DUMPABLE, 1);  // its /proc/self/fd is its own again
            ::umask(mask);
            try {
                write_atomically(t / "a", [](std::ostream& out) { out << "new"; });
            } catch (const Error&) {
                ::_exit(1);
            }
            ::_exit(0);
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        EXPECT_EQ(status, 0) << std::oct << mask;
        struct stat s {};
        ASSERT_EQ(::stat((t / "a").c_str(), &s), 0) << std::oct << mask;
        EXPECT_EQ(s.st_mode & 07777, 0666u & ~mask) << std::oct << mask;
        ::unlink((t / "a").c_str());
    }
}
TEST(AtomicFile, FollowsLinksToWhatIsNotThereYet) {
    namespace fs = std::filesystem;
    const TemporaryFolder t;
    const auto text = [](std::ostream& out) { out << "new"; };
    fs::create_directory(t / "there");
    fs::create_symlink("there/b", t / "a");
    fs::create_symlink("../there/c", t / "there/b");
    write_atomically(t / "a", text);
    EXPECT_TRUE(fs::is_symlink(t / "a") && fs::is_symlink(t / "there/b"));
    EXPECT_EQ(read_all(t / "there/c"), "new");
    fs::create_symlink("y", t / "x");
    fs::create_symlink("x", t / "y");
    EXPECT_EQ(kind_of([&] { write_atomically(t / "x", text); }, "Too many levels of symbolic links"), ErrorKind::io);
    for (int k = 0; k < 50; ++k) fs::create_symlink("l" + std::to_string(k + 1), t / ("l" + std::to_string(k)));
    EXPECT_EQ(kind_of([&] { write_atomically(t / "l0", text); }, "Too many levels of symbolic links"), ErrorKind::io);
    fs::create_symlink("no/such", t / "z");
    EXPECT_EQ(kind_of([&] { write_atomically(t / "z", text); }, "No such file or directory"), ErrorKind::io);
    EXPECT_EQ(t.files(), 55u);  // a, there, x, y, 50, z
}
TEST(AtomicFile, NamesMayBeAsLongAsTheFileSystemTakes) {
    const TemporaryFolder t;
    const std::string name(255, 'n');
    for (const char* text : {"old", "new"}) write_atomically(t / name, [&](std::ostream& out) { out << text; });
    EXPECT_EQ(read_all(t / name), "new");
    EXPECT_EQ(t.files(), 1u);
}
TEST(AtomicFile, SaysWhyItCannotWrite) {
    const TemporaryFolder t;
    const auto text = [](std::ostream& out) { out << "text"; };
    EXPECT_EQ(kind_of([&] { write_atomically(t.path(), text); }, "Is a directory"), ErrorKind::io);
    EXPECT_EQ(kind_of([&] { write_atomically(t / "no/such/folder", text); }, "No such file or directory"), ErrorKind::io);
    EXPECT_EQ(kind_of([&] { write_atomically("", text); }, "is empty"), ErrorKind::io);
    if (std::filesystem::exists("/dev/full")) {
        EXPECT_EQ(kind_of([&] { write_atomically("/dev/full", text); }, "No space left on device"), ErrorKind::io);
    }
}
TEST(AtomicFile, ByNameAnotherLibraryWrites) {
    const TemporaryFolder t;
    write_atomically_by_name(t / "a.png", [&](const std::string& name) {
        EXPECT_NE(name, t / "a.png");
        write_all(name, "x");
    });
    EXPECT_EQ(read_all(t / "a.png"), "x");
    EXPECT_EQ(t.files(), 1u);
}
/// As libjpeg ends the program that cannot write.
TEST(AtomicFile, AnExitWithinRemovesTheTemporary) {
    const TemporaryFolder t;
    const pid_t child = ::fork();
    if (child == 0) {
        write_atomically(t / "a", [](std::ostream& out) {
            out << "half" << std::flush;
            std::exit(0);
        });
        ::_exit(1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(t.files(), 0u);
}
TEST(AtomicFile, ASignalRemovesTheTemporary) {
    const TemporaryFolder t;
    const pid_t child = ::fork();
    if (child == 0) {
        write_atomically(t / "a", [](std::ostream& out) {
            out << "half" << std::flush;
            ::raise(SIGTERM);
        });
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
    EXPECT_EQ(t.files(), 0u);
}

}  // namespace
}  // namespace isoparm
