// long_render_test.cpp -- pictures that take long: ended and killed runs that go on to the same pixels, noise targets that keep the mean.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <sstream>
#include <thread>

#include "error.h"
#include "picture/picture.h"
#include "run_program.h"
#include "samples.h"

namespace isoparm {
namespace {

using test::read_all;
using test::TemporaryFolder;
using test::write_all;

/// A translucent sheet over a ball on a floor, half out of the picture; `more` stands within "image".
std::string scene_text(const std::string& more, const std::string& lighting = R"("lighting": {"bounces": 2, "lights": [{"type": "sphere", "center": [2,-2,3], "radius": 0.4, "radiance": 30}, {"type": "environment", "radiance": 0.2}]},)") {
    return R"({"isoparm": 1, "surfaces": {"floor": {"type": "bilinear", "points": [[-9,-9,0], [-9,9,0], [9,-9,0], [9,9,0]]}, "sheet": {"type": "bilinear", "points": [[-2,0,0.2], [-2,0.5,2], [2,0,0.2], [2,0.5,2]]}},
        "objects": [{"surface": "floor"}, {"surface": "sheet", "opacity": 0.4}, {"point": [0,1,0.7], "radius": 0.7}], )" + lighting + R"(
        "camera": {"eye": [0,-6,3], "target": [0,0,0.9], "up": [0,0,1], "fov": 40}, "image": {"width": 45, "height": 29)" + more + "}}";
}
Scene scene_of(const std::string& text) {
    const TemporaryFolder folder;
    write_all(folder / "s.json", text);
    return load_scene(folder / "s.json");
}

bool same(const Picture& a, const Picture& b) { return a.image.pixels == b.image.pixels && a.layers.values == b.layers.values; }

/// Says true after it was asked n times.
std::function<bool()> after(int n) {
    auto left = std::make_shared<std::atomic<int>>(n);
    return [left] { return --*left < 0; };
}

TEST(LongRender, StoppedAndResumedAnywhereItEndsWithTheSamePixels) {
    for (const std::string& noise : {std::string(""), std::string(R"(, "noise": 0.02)")}) {
        const Scene scene = scene_of(scene_text(R"(, "samples": 80, "background": "transparent")" + noise));
        RenderOptions options;
        options.aovs = {Aov::sample_variance, Aov::samples};
        const Picture whole = render(scene, options);
        EXPECT_TRUE(whole.whole);
        tests::Random random(3);
        for (const int threads : {1, 2, 7}) {
            const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
            const TemporaryFolder folder;
            RenderOptions again = options;
            again.checkpoint = {folder / "checkpoint", "scene 1\n", 60};
            again.tile = threads == 1 ? 1 : threads == 2 ? 5 : 64;
            int ended = 0;
            for (int tries = 0; tries < 200; ++tries) {
                again.stop = after(static_cast<int>(1000 * random.number()));
                const Picture p = render(scene, again);
                if (p.whole) {
                    EXPECT_TRUE(same(p, whole)) << noise << " " << threads;
                    break;
                }
                ++ended;
                for (const float c : p.image.pixels) ASSERT_TRUE(std::isfinite(c));  // whole, whenever it ends
            }
            EXPECT_GT(ended, 1);
        }
    }
}

TEST(LongRender, ExactPicturesCountTheirRaysAcrossStops) {
    const Scene scene = scene_of(scene_text(R"(, "samples": 32)"));
    RenderOptions options;
    options.exact = true;
    const Picture whole = render(scene, options);
    EXPECT_GT(whole.rays.rays, 10000u);
    const TemporaryFolder folder;
    options.checkpoint = {folder / "checkpoint", "scene 1\n", 60};
    options.stop = after(500);
    EXPECT_FALSE(render(scene, options).whole);
    options.stop = {};
    options.preview = [](const Picture&) {};
    const Picture resumed = render(scene, options);
    EXPECT_TRUE(same(resumed, whole));
    EXPECT_EQ(resumed.rays.rays, whole.rays.rays);
    EXPECT_EQ(resumed.rays.undecided, whole.rays.undecided);
}

TEST(LongRender, CheckpointsOfOtherPicturesAndDamagedOnesAreRefused) {
    const Scene scene = scene_of(scene_text(R"(, "samples": 64)"));
    const TemporaryFolder folder;
    RenderOptions options;
    options.checkpoint = {folder / "checkpoint", "scene 1\nsamples 64\n", 60};
    options.stop = after(500);
    EXPECT_FALSE(render(scene, options).whole);
    const std::string good = read_all(folder / "checkpoint");
    const auto message = [&](const std::string& bytes, const std::string& key = "scene 1\nsamples 64\n") -> std::string {
        write_all(folder / "checkpoint", bytes);
        options.checkpoint.key = key;
        options.stop = {};
        try {
            render(scene, options);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input) << e.what();
            return e.what();
        }
        return "";
    };
    EXPECT_NE(message(good, "scene 1\nsamples 128\n").find("whose samples was \"64\", expected \"128\""), std::string::npos);
    EXPECT_NE(message(good.substr(0, good.size() - 1)).find("cut off or damaged"), std::string::npos);
    EXPECT_NE(message(good + "x").find("cut off or damaged"), std::string::npos);
    for (const std::size_t size : {0, 1, 20, 29, 40}) EXPECT_NE(message(good.substr(0, size)), "") << size;
    tests::Random random(5);
    for (int i = 0; i < 60; ++i) {
        std::string bytes = good;
        const std::size_t at = static_cast<std::size_t>(random.number() * static_cast<double>(bytes.size()));
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << static_cast<int>(8 * random.number())));
        EXPECT_NE(message(bytes), "") << at;
    }
    for (const char* huge : {"99999999999999999999", "1048577", "4294967295", "-1"}) EXPECT_NE(message(good.substr(0, 29) + huge + "\n" + good), "") << huge;
    EXPECT_EQ(message(good), "");
}

TEST(LongRender, FilmsThatLieAreRefused) {
    Film film({0, 0, 8, 8}, 64, 0.1, {});
    const auto refused = [&] {
        std::stringstream bytes;
        film.write(bytes);
        return !Film({0, 0, 8, 8}, 64, 0.1, {}).read(bytes);
    };
    EXPECT_FALSE(refused());
    const PixelSum none;
    for (const auto& [used, seen] : {std::pair{16, 0}, {-16, 0}, {0, 16}, {32, 32}, {5, 5}, {1 << 30, 1 << 30}}) {
        film.at(3, 4).used = used, film.at(3, 4).seen = seen;  // the spread has no samples
        EXPECT_TRUE(refused()) << used << " " << seen;
    }
    film.at(3, 4) = none;
    film.at(3, 4).alpha = std::nan("");
    EXPECT_TRUE(refused());
}

TEST(LongRender, NoiseTargetsDoNotDependOnThreadsTilesAndCrops) {
    const Scene scene = scene_of(scene_text(R"(, "samples": 512, "noise": 0.012)"));
    RenderOptions options;
    options.aovs = {Aov::samples};
    const Picture whole = render(scene, options);
    EXPECT_EQ(whole.samples.least, 16);
    EXPECT_GT(whole.samples.most, 64);
    for (const int threads : {1, 2, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
        RenderOptions other = options;
        other.tile = threads == 1 ? 3 : 33;
        EXPECT_TRUE(same(render(scene, other), whole)) << threads;
        other.crop = {9, 5, 31, 29};
        const Picture part = render(scene, other);
        for (int y = 0; y < part.image.height; ++y)
            for (int x = 0; x < part.image.width; ++x)
                ASSERT_EQ(std::memcmp(part.image.at(x, y), whole.image.at(x + 9, y + 5), 4 * sizeof(float)), 0) << x << "," << y;
    }
}

TEST(LongRender, NoiseTargetsKeepTheMean) {
    // Samples are independent here, and one in fifty is 50 times as bright: whoever stops a pixel when its own samples agree loses light.
    const double truth = 0.02 * 5 + 0.98 * 0.1;
    tests::Random random(11);
    const int size = 512;
    Film film({0, 0, size, size}, 1024, 0.06, {});
    double own = 0;  // what stopping on one's own samples would give, for comparison: to show that the test can fail
    do {
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                PixelSum& p = film.at(x, y);
                if (!film.goes_on(x, y)) continue;
                const bool counts = film.counts(x, y);
                for (; p.seen < film.round(); ++p.seen) {
                    const double c = random.number() < 0.02 ? 5 : 0.1;
                    film.pixel(x, y).spread->add({c, c, c});
                    if (counts) p.color += Color{c, c, c}, ++p.used;
                }
            }
    } while (film.next_round());
    double sum = 0, squares = 0;
    int least = 1 << 30, most = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double mean = film.at(x, y).color.x / film.at(x, y).used;
            sum += mean, squares += mean * mean;
            least = std::min(least, film.at(x, y).used), most = std::max(most, film.at(x, y).used);
        }
    const double n = double(size) * size, mean = sum / n, error = std::sqrt((squares / n - mean * mean) / n);
    EXPECT_LT(least, most);
    EXPECT_NEAR(mean, truth, 4 * error);
    EXPECT_LT(error, 0.002 * truth);
    // The same with each pixel's own spread.
    for (int i = 0; i < size * size; ++i) {
        Spread s;
        double total = 0;
        int count = 0;
        for (int round = 16; round <= 1024; round *= 2) {
            for (; count < round; ++count) {
                const double c = random.number() < 0.02 ? 5 : 0.1;
                s.add({c, c, c}), total += c;
            }
            if (std::sqrt(s.variance().x / count) * 1.5 <= 0.06) break;
        }
        own += total / count / n;
    }
    EXPECT_LT(own, 0.97 * truth);
}

TEST(LongRender, NoiseTargetsAreReached) {
    const Scene scene = scene_of(scene_text(R"(, "samples": 4096, "noise": 0.015)"));
    const Picture p = render(scene, {});
    EXPECT_EQ(p.samples.missed, 0);
    EXPECT_LT(p.samples.noise, 0.015);
    EXPECT_LT(p.samples.mean, 2048);
    // The real error, against many samples: Sobol' points do better than independent ones, for which the target is made.
    RenderOptions many;
    many.noise = 0, many.samples = 1024;
    const Picture reference = render(scene, many);
    double sum = 0;
    const auto shown = [](float x) { return x <= 0.0031308f ? 12.92 * double(x) : 1.055 * std::pow(double(x), 1 / 2.4) - 0.055; };
    for (std::size_t i = 0; i < p.image.pixels.size(); ++i)
        if (i % 4 != 3) sum += std::pow(shown(p.image.pixels[i]) - shown(reference.image.pixels[i]), 2);
    const double error = std::sqrt(sum / (3.0 * 45 * 29));
    EXPECT_LT(error, 0.01);
    RecordProperty("error", std::to_string(error));
    EXPECT_GT(error, 0.0005);
}

// ---- the program

/// Runs it, and sends a signal after so many milliseconds; the exit status as waitpid() has it.
int signalled(const std::vector<std::string>& words, int signal, int milliseconds) {
    std::vector<char*> arguments;
    for (const std::string& w : words) arguments.push_back(const_cast<char*>(w.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
        ::execv(arguments[0], arguments.data());
        ::_exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    ::kill(child, signal);
    int status = 0;
    ::waitpid(child, &status, 0);
    return status;
}

TEST(LongRenderProgram, KilledRunsGoOnToTheSameBytes) {
    const TemporaryFolder folder;
    write_all(folder / "s.json", scene_text(R"(, "samples": 400)"));
    const std::string base = "render " + folder / "s.json" + " --quiet --size 60x40 ";
    ASSERT_EQ(test::run(base + "-o " + folder / "whole.exr").code, 0);
    int killed = 0;
    for (int k = 0; k < 5; ++k) {
        const int status = signalled({test::program(), "render", folder / "s.json", "--quiet", "--size", "60x40", "-o", folder / "again.exr", "--resume", folder / "checkpoint", "--checkpoint-every", "0.1",
                                      "--threads", k % 2 ? "1" : "3"}, SIGKILL, 250 + 37 * k);
        if (WIFSIGNALED(status)) {
            ++killed;
            EXPECT_FALSE(std::filesystem::exists(folder / "again.exr"));
            continue;
        }
        EXPECT_EQ(WEXITSTATUS(status), 0);
        break;
    }
    ASSERT_EQ(test::run(base + "-o " + folder / "again.exr --resume " + folder / "checkpoint").code, 0);
    EXPECT_EQ(read_all(folder / "again.exr"), read_all(folder / "whole.exr"));
    EXPECT_FALSE(std::filesystem::exists(folder / "checkpoint"));
    RecordProperty("killed", killed);
}

TEST(LongRenderProgram, InterruptedRunsWriteWhatTheyHave) {
    for (const int signal : {SIGINT, SIGTERM}) {
        const TemporaryFolder folder;
        write_all(folder / "s.json", scene_text(R"(, "samples": 65536)"));
        const int status = signalled({test::program(), "render", folder / "s.json", "--quiet", "-o", folder / "a.exr", "--preview"}, signal, 1000);
        ASSERT_TRUE(WIFEXITED(status));
        EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
        const Image image = read_image(folder / "a.exr");
        EXPECT_EQ(image.width, 45);
        EXPECT_EQ(folder.files(), 2u);
        const std::string bytes = read_all(folder / "a.exr");
        EXPECT_NE(bytes.find("isoparm:unfinished"), std::string::npos);
        EXPECT_NE(bytes.find("isoparm:samples"), std::string::npos);
    }
}

TEST(LongRenderProgram, WrongOptionsAreTold) {
    const TemporaryFolder folder;
    write_all(folder / "s.json", scene_text(R"(, "samples": 1)"));
    const std::string base = "render " + folder / "s.json" + " -o " + folder / "a.png ";
    for (const char* wrong : {"--noise -1", "--noise 1e-300", "--noise nan", "--noise 2", "--noise x", "--checkpoint-every 1", "--resume ck --checkpoint-every 0", "--resume ck --checkpoint-every 1e9"})
        EXPECT_EQ(test::run(base + wrong, folder.path()).code, 64) << wrong;
    EXPECT_EQ(test::run(base + "--resume " + folder / "s.json").code, 64);   // the scene itself
    EXPECT_EQ(test::run(base + "--resume " + folder / "none/x").code, 4);
    write_all(folder / "other", "not a checkpoint");
    const test::Outcome other = test::run(base + "--resume " + folder / "other");
    EXPECT_EQ(other.code, 65);
    EXPECT_NE(other.err.find("found no checkpoint"), std::string::npos) << other.err;
    EXPECT_EQ(read_all(folder / "other"), "not a checkpoint");
    // A target that cannot be reached is a warning, and the picture is there.
    write_all(folder / "s.json", scene_text(R"(, "samples": 16, "noise": 1e-5)"));
    const test::Outcome poor = test::run(base);
    EXPECT_EQ(poor.code, 1);
    EXPECT_NE(poor.err.find("did not come to a noise of 1e-05"), std::string::npos) << poor.err;
    EXPECT_TRUE(std::filesystem::exists(folder / "a.png"));
    EXPECT_EQ(test::run(base + "--noise 0").code, 0);
}

}  // namespace
}  // namespace isoparm
