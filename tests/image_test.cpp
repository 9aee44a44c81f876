// Image files: what is written comes back, or nothing is left behind.
#include "image/image.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "commands/interruption.h"
#include "error.h"
#include "io/atomic_file.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

class ImageFiles : public testing::Test {
protected:
    ImageFiles() : folder_(fs::temp_directory_path() / ("isoparm-image-" + std::to_string(getpid()))) {
        fs::create_directories(folder_);
    }
    ~ImageFiles() override {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::size_t files() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }
    fs::path folder_;
};

/// A ramp of colours and coverages, premultiplied; every value is a half float.
Image ramp(bool opaque) {
    Image image{32, 8, {}};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float alpha = opaque ? 1.0f : y / 8.0f;
            for (const float c : {x / 32.0f, y / 16.0f, 0.25f}) image.pixels.push_back(alpha * c);
            image.pixels.push_back(alpha);
        }
    return image;
}

std::string bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    std::stringstream all;
    all << in.rdbuf();
    return all.str();
}

double srgb(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

TEST_F(ImageFiles, ExrKeepsHalfFloatsExactly) {
    for (const bool opaque : {false, true}) {
        const Image image = ramp(opaque);
        write_image(path("a.exr"), image, {{"isoparm:scene", "ramp"}});
        const Image back = read_image(path("a.exr"));
        ASSERT_EQ(back.width, image.width);
        ASSERT_EQ(back.height, image.height);
        EXPECT_EQ(back.pixels, image.pixels);
    }
}

TEST_F(ImageFiles, PngHoldsRoundedSrgb) {
    // Half of 255 in sRGB is 0.2140 linear (IEC 61966-2-1).
    Image image{1, 1, {0.21404114f, 0.0f, 1.0f, 1.0f}};
    write_image(path("a.png"), image, {});
    const Image back = read_image(path("a.png"));
    EXPECT_NEAR(srgb(back.pixels[0]), 128 / 255.0, 1e-6);
    EXPECT_EQ(back.pixels[1], 0);
    EXPECT_EQ(back.pixels[2], 1);
}

TEST_F(ImageFiles, EightBitFilesAreWithinHalfAStep) {
    for (const bool opaque : {false, true})
        for (const char* name : {"a.png", "a.tif", "a.tga"}) {
            const Image image = ramp(opaque);
            write_image(path(name), image, {});
            const Image back = read_image(path(name));
            ASSERT_EQ(back.pixels.size(), image.pixels.size()) << name;
            for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
                const float alpha = image.pixels[i + 3];
                ASSERT_NEAR(back.pixels[i + 3], alpha, 0.5 / 255 + 1e-6) << name;
                for (int k = 0; k < 3 && alpha > 0; ++k)
                    ASSERT_NEAR(srgb(back.pixels[i + k] / back.pixels[i + 3]), srgb(image.pixels[i + k] / alpha),
                                0.5 / 255 + 1e-5)
                        << name;
            }
        }
}

// Larger than what is compressed at once, with every filter of rows: even, sloping and noisy ones; a name that is not ASCII.
TEST_F(ImageFiles, LargePngsReadBackAndKeepTheirTexts) {
    Image image{640, 400, {}};
    for (unsigned i = 0, x = 1; i < 640 * 400; ++i) {
        const unsigned row = i / 640, column = i % 640;
        x = x * 1664525u + 1013904223u;
        const float value = row % 4 == 0 ? 0.5f : row % 4 == 1 ? static_cast<float>(column) / 640 : row % 4 == 2 ? static_cast<float>(row + column) / 1040 : static_cast<float>(x) * 0x1p-32f;
        const float alpha = row < 300 ? 1.0f : static_cast<float>(column) / 640;
        for (const float c : {value, 1 - value, 0.25f}) image.pixels.push_back(alpha * c);
        image.pixels.push_back(alpha);
    }
    write_image(path("a.png"), image, {{"isoparm:title", "B\u00e9zier"}});
    EXPECT_NE(bytes(path("a.png")).find("B\u00e9zier"), std::string::npos);
    const Image back = read_image(path("a.png"));
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        const float alpha = image.pixels[i + 3];
        ASSERT_NEAR(back.pixels[i + 3], alpha, 0.5 / 255 + 1e-6) << i;
        for (int k = 0; k < 3 && back.pixels[i + 3] > 0; ++k) ASSERT_NEAR(srgb(back.pixels[i + k] / back.pixels[i + 3]), srgb(image.pixels[i + k] / alpha), 0.5 / 255 + 1e-5) << i;
    }
}

TEST_F(ImageFiles, FormatsWithoutAlphaShowThePictureOnWhite) {
    const Image image{2, 1, {0, 0, 0, 0, 0, 0, 0, 1}};
    write_image(path("a.ppm"), image, {});
    const Image back = read_image(path("a.ppm"));
    EXPECT_EQ(back.pixels, (std::vector<float>{1, 1, 1, 1, 0, 0, 0, 1}));
}

TEST_F(ImageFiles, TheSamePictureGivesTheSameBytes) {
    for (const char* name : {"a.exr", "a.png"}) {
        write_image(path(name), ramp(false), {{"isoparm:scene", "ramp"}});
        const std::string first = bytes(path(name));
        sleep(1);  // a date in the file would differ
        write_image(path(name), ramp(false), {{"isoparm:scene", "ramp"}});
        EXPECT_EQ(bytes(path(name)), first) << name;
        EXPECT_NE(first.find("ramp"), std::string::npos) << name << " lost its metadata";
    }
}

TEST_F(ImageFiles, AMissingFolderIsNamedAndNothingIsLeft) {
    const std::string file = path("no/such/a.png");
    for (const auto& attempt : {+[](const std::string& f) { write_image(f, ramp(true), {}); },
                                +[](const std::string& f) { check_image_path(f); }})
        try {
            attempt(file);
            ADD_FAILURE() << "was written";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::io);
            EXPECT_NE(std::string(e.what()).find(file), std::string::npos) << e.what();
        }
    EXPECT_EQ(files(), 0u);
}

TEST_F(ImageFiles, AReadOnlyFolderIsNamedAndNothingIsLeft) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
    fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
    EXPECT_THROW(write_image(path("a.png"), ramp(true), {}), Error);
    fs::permissions(folder_, fs::perms::owner_all);
    EXPECT_EQ(files(), 0u);
}

TEST_F(ImageFiles, AnUnknownExtensionListsTheKnownOnes) {
    for (const char* name : {"a.pgn", "a", "a.png.old"}) try {
            write_image(path(name), ramp(true), {});
            ADD_FAILURE() << "was written";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::usage);
            EXPECT_NE(std::string(e.what()).find("exr, png"), std::string::npos) << e.what();
        }
    EXPECT_EQ(files(), 0u);
}

TEST_F(ImageFiles, AFullDiskLeavesTheOldFile) {
    // A limit on the size of files stands for the full disk: writing stops in the middle of the file.
    Image noise{256, 256, {}};
    for (unsigned i = 0, x = 1; i < 4 * 256 * 256; ++i)
        noise.pixels.push_back(i % 4 == 3 ? 1.0f : (x = x * 1664525u + 1013904223u) * 0x1p-32f);
    for (const char* name : {"a.png", "a.exr", "a.tif", "a.tga"}) {
        write_image(path(name), ramp(true), {});
        const std::string old = bytes(path(name));
        rlimit before{};
        getrlimit(RLIMIT_FSIZE, &before);
        const auto handler = signal(SIGXFSZ, SIG_IGN);
        const rlimit small{20000, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
        EXPECT_THROW(write_image(path(name), noise, {}), Error) << name;
        setrlimit(RLIMIT_FSIZE, &before);
        signal(SIGXFSZ, handler);
        EXPECT_EQ(bytes(path(name)), old) << name;
    }
    EXPECT_EQ(files(), 4u);
}

TEST_F(ImageFiles, WhatIsNoImageIsRefused) {
    std::ofstream(path("a.png")) << "not an image";
    EXPECT_THROW(read_image(path("a.png")), Error);
    EXPECT_THROW(read_image(path("none.exr")), Error);
}

/// Libraries go back in the file that they write, and read it again: a pipe gets what they made, byte by byte.
TEST_F(ImageFiles, GoToPipes) {
    for (const std::string extension : {"png", "exr", "tif", "jpg"}) {
        const std::string pipe = path("pipe." + extension), file = path("file." + extension);
        ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
        std::string got;
        std::thread reader([&] { got = bytes(pipe); });
        EXPECT_NO_THROW(write_image(pipe, ramp(true), {}));
        if (const int other = ::open(pipe.c_str(), O_WRONLY | O_NONBLOCK); other >= 0) ::close(other);  // where writing failed, the reader must not wait
        reader.join();
        write_image(file, ramp(true), {});
        EXPECT_EQ(got, bytes(file)) << extension;
        EXPECT_GT(got.size(), 100u);
    }
}

/// Nobody may ever read it, and a picture's first signal is otherwise only noted.
TEST_F(ImageFiles, WaitForReadersOfPipesUntilTheFirstSignal) {
    const std::string pipe = path("pipe.ppm");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const auto wait = [&] {
        ::alarm(20);
        const Interruption interruption(true);
        std::thread([] {
            while (!writing_to_device()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
            ::kill(::getpid(), SIGTERM);
        }).detach();
        write_atomically(pipe, [](std::ostream& out) { out << "P6"; });
    };
    EXPECT_EXIT(wait(), testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace isoparm
