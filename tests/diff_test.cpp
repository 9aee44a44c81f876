// The numbers of diff: laws that they keep, values worked out another way, and files that nobody vouches for.
#include "diff/diff.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "diff/flip.h"
#include "diff/image_diff.h"
#include "diff/ssim.h"
#include "error.h"
#include "image/image.h"
#include "image/image_decoder.h"
#include "image/image_header.h"
#include "image/image_layers.h"
#include "image/image_loader.h"
#include "run_program.h"

namespace isoparm {
namespace {

using test::read_all, test::write_all;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();

ImagePart part(int width, int height, std::vector<std::string> channels) {
    ImagePart p;
    p.data = p.display = {0, 0, width, height};
    p.types.assign(channels.size(), "float");
    p.channels = std::move(channels);
    return p;
}

PartDiff measured(const std::vector<double>& a, const std::vector<double>& b, const DiffLimits& limits = {}, const DiffMask& mask = {}) {
    const ImagePart p = part(static_cast<int>(a.size()) / 2, 1, {"R", "G"});
    DiffMeter meter(p, p, limits, mask);
    meter.add(a.data(), b.data(), 1);
    return meter.result();
}

TEST(Diff, NumbersOfTwoPixelsByHand) {
    // |R| differs by 0.5 and 0, |G| by 0.25 and 2: means 0.25 and 1.125, mean squares 0.125 and 2.03125.
    const PartDiff d = measured({1, 1, 0.5, 4}, {0.5, 1.25, 0.5, 2});
    ASSERT_EQ(d.channels.size(), 2u);
    EXPECT_EQ(d.channels[0].max, 0.5);
    EXPECT_EQ(d.channels[0].mean(), 0.25);
    EXPECT_DOUBLE_EQ(d.channels[0].rms(), std::sqrt(0.125));
    EXPECT_DOUBLE_EQ(d.channels[0].psnr(), 20 * std::log10(1 / std::sqrt(0.125)));
    EXPECT_EQ(d.channels[1].max, 2);
    EXPECT_DOUBLE_EQ(d.channels[1].psnr(), 20 * std::log10(4 / std::sqrt(2.03125))) << "the peak is the largest value";
    EXPECT_EQ(d.channels[1].worst.x, 1);
    EXPECT_EQ(d.channels[1].worst.a, 4);
    EXPECT_EQ(d.channels[1].worst.b, 2);
    EXPECT_EQ(d.pixels, 2u);
    EXPECT_EQ(d.failing, 2u) << "pixels, not samples";
    EXPECT_EQ(d.channels[0].percentile(0.5), 0);
    EXPECT_NEAR(d.channels[0].percentile(1), 0.5, 0.004);
}

TEST(Diff, WhatIsNotFiniteFailsBeyondAllLimits) {
    DiffLimits open;
    open.fail = open.warn = {1e300, 100, 1e300};
    for (const auto& [a, b] : {std::pair{1.0, kNan}, {kNan, 1.0}, {kNan, kNan}, {kInf, kInf}, {kInf, -kInf}, {1.0, kInf}}) {
        const PartDiff d = measured({0, a}, {0, b}, open);
        EXPECT_EQ(judge({d}, open), DiffVerdict::fail) << a << " " << b;
        EXPECT_EQ(d.nonfinite, 1u);
        EXPECT_TRUE(std::isfinite(d.channels[1].mean()) && std::isfinite(d.channels[1].rms()) && std::isfinite(d.channels[1].max));
    }
    DiffLimits allowed;
    allowed.allow_nonfinite = true;
    for (const double same : {kNan, kInf, -kInf}) EXPECT_EQ(judge({measured({0, same}, {0, same}, allowed)}, allowed), DiffVerdict::pass);
    EXPECT_EQ(judge({measured({0, kInf}, {0, -kInf}, allowed)}, allowed), DiffVerdict::fail);
    EXPECT_EQ(judge({measured({0, 1}, {0, kNan}, allowed)}, allowed), DiffVerdict::fail);
    EXPECT_EQ(judge({measured({0.0, 1}, {-0.0, 1})}, {}), DiffVerdict::pass) << "the sign of a zero";
}

TEST(Diff, TiersArePercentagesOfPixels) {
    std::vector<double> a(20, 0.5), b = a;
    b[0] += 0.1, b[1] += 0.1, b[4] += 0.01;  // pixels 0 and 2 of ten
    DiffLimits l;
    const auto verdict = [&] { return judge({measured(a, b, l)}, l); };
    l.fail = {0.05, 10, kInf}, l.warn = {1, 0, kInf};
    EXPECT_EQ(verdict(), DiffVerdict::pass) << "10 % of the pixels are allowed";
    l.fail.percent = 9.9;
    EXPECT_EQ(verdict(), DiffVerdict::fail);
    l.fail = {0.2, 0, kInf}, l.warn = {0.001, 19, kInf};
    EXPECT_EQ(verdict(), DiffVerdict::warn);
    l.warn.percent = 20;
    EXPECT_EQ(verdict(), DiffVerdict::pass);
    l.fail.hard = 0.09;
    EXPECT_EQ(verdict(), DiffVerdict::fail);
    l.fail.hard = kInf, l.warn.hard = 0.09;
    EXPECT_EQ(verdict(), DiffVerdict::warn);
    l.channels = {{"G", 0.01}};
    EXPECT_EQ(verdict(), DiffVerdict::fail) << "a limit of one channel";
    l.channels = {{"G*", 0.5}, {"R", 0.5}};
    l.warn.hard = kInf;
    EXPECT_EQ(verdict(), DiffVerdict::pass);
}

TEST(Diff, OnlyTheMaskCounts) {
    const DiffMask second{false, true};
    EXPECT_EQ(judge({measured({0, 0, 1, 1}, {1, kNan, 1, 1}, {}, second)}, {}), DiffVerdict::pass);
    const PartDiff d = measured({0, 0, 1, 1}, {0, 0, 1, 2}, {}, second);
    EXPECT_EQ(d.pixels, 1u);
    EXPECT_EQ(d.failing, 1u);
}

TEST(Diff, BlocksAndOrderOfChannelsDoNotMatter) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> value(0, 1);
    const ImagePart p = part(13, 9, {"R", "G", "B"}), q = part(13, 9, {"B", "R", "G"});
    std::vector<float> a(13 * 9 * 3), b(a.size()), turned(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) a[i] = value(random), b[i] = i % 5 ? a[i] : value(random);
    for (std::size_t i = 0; i < a.size(); i += 3) turned[i] = b[i + 2], turned[i + 1] = b[i], turned[i + 2] = b[i + 1];
    const DiffLimits limits;
    const DiffMask all;
    DiffMeter whole(p, p, limits, all), rows(p, q, limits, all);
    whole.add(a.data(), b.data(), 9);
    for (int y = 0; y < 9; ++y) rows.add(&a[static_cast<std::size_t>(y) * 39], &turned[static_cast<std::size_t>(y) * 39], 1);
    const PartDiff x = whole.result(), y = rows.result();
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(x.channels[c].sum, y.channels[c].sum);
        EXPECT_EQ(x.channels[c].squares, y.channels[c].squares);
        EXPECT_EQ(x.channels[c].histogram, y.channels[c].histogram);
        EXPECT_GE(x.channels[c].max, x.channels[c].percentile(0.99));
        EXPECT_GE(x.channels[c].rms(), x.channels[c].mean());
    }
    EXPECT_EQ(x.failing, y.failing);
}

TEST(Diff, HalvesAreTheNumbersThatTheyStand) {
    // 1, 1.5, 2^-24, 65504; -2, NaN, Inf, and 0 with either sign.
    const std::vector<HalfBits> a{0x3c00, 0x3e00, 0x0001, 0x7bff}, b{0x3c00, 0x3c00, 0x0000, 0x7bff};
    const ImagePart p = part(2, 1, {"R", "G"});
    const DiffLimits limits;
    const DiffMask all;
    DiffMeter meter(p, p, limits, all), same(p, p, limits, all), odd(p, p, limits, all);
    meter.add(a.data(), b.data(), 1);
    EXPECT_EQ(meter.result().channels[0].max, 0x1p-24);
    EXPECT_EQ(meter.result().channels[1].max, 0.5);
    EXPECT_EQ(meter.result().channels[1].peak, 65504);
    same.add(a.data(), a.data(), 1);
    EXPECT_EQ(same.result().channels[1].peak, 65504);
    EXPECT_EQ(same.result().channels[1].samples, 2u);
    EXPECT_EQ(judge({same.result()}, limits), DiffVerdict::pass);
    const std::vector<HalfBits> c{0xc000, 0x7e00, 0x7c00, 0x0000}, d{0xc000, 0x7e00, 0x7c00, 0x8000};
    odd.add(c.data(), c.data(), 1);
    EXPECT_EQ(odd.result().nonfinite, 2u) << "equal bits are not enough";
    DiffMeter zeros(p, p, limits, all);
    zeros.add(c.data(), d.data(), 1);
    EXPECT_EQ(zeros.result().channels[1].differing, 1u) << "NaN, and not the sign of the zero";
}

TEST(Diff, PartsThatDifferInShapeAreNotCompared) {
    const ImagePart a = part(4, 3, {"R", "G"});
    EXPECT_TRUE(incomparable(a, a).empty());
    const auto because = [&](const auto& change, const std::string& word) {
        ImagePart b = a;
        change(b);
        const auto why = incomparable(a, b);
        ASSERT_FALSE(why.empty()) << word;
        EXPECT_NE(why[0].find(word), std::string::npos) << why[0];
    };
    because([](ImagePart& b) { b.data.width = 5; }, "size");
    because([](ImagePart& b) { b.data.x = 1; }, "data window");
    because([](ImagePart& b) { b.display.height = 9; }, "display window");
    because([](ImagePart& b) { b.channels = {"R"}; }, "missing: G");
    because([](ImagePart& b) { b.channels.push_back("Z"); }, "lacks: Z");
    because([](ImagePart& b) { b.space = {"oiio:ColorSpace=sRGB"}; }, "colour space");
}

// ---- FLIP and SSIM ----------------------------------------------------------------------------------------------------
// Values from another implementation of the same papers, in NumPy with two-dimensional kernels in double, and the same from the authors' functions
// (python/flip_api.py of NVlabs/flip, 2021), followed line by line; SSIM from scikit-image 0.19.3 (gaussian_weights, sigma 1.5, use_sample_covariance false).

struct Colors {
    int width, height;
    std::vector<float> a, b;
};
/// Stripes, a checkerboard and rings; in the other one a darker square, a grey bar and a stripe turned over.
Colors sample_colors() {
    Colors c{56, 40, {}, {}};
    for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
            const double rgb[3] = {((x * 7 + y * 3) % 16 + 1) / 20.0, (x / 6 + y / 5) % 2 * 0.75 + 0.1, (x * x + y * y) % 29 / 32.0};
            double other[3] = {rgb[0], rgb[1], rgb[2]};
            if (y >= 10 && y < 20 && x >= 12 && x < 30) other[0] *= 0.5;
            if (y >= 5 && y < 35 && x >= 40 && x < 44) other[0] = other[1] = other[2] = 0.25;
            if (y >= 25 && y < 30 && x >= 3 && x < 20) other[1] = 1 - other[1];
            for (int k = 0; k < 3; ++k) c.a.push_back(static_cast<float>(rgb[k])), c.b.push_back(static_cast<float>(other[k]));
        }
    return c;
}

std::vector<float> flip_map(const Colors& c, const FlipOptions& options, int block = 7) {
    std::vector<float> map;
    FlipMeter meter(c.width, c.height, options, [&](int y, const float* row) {
        EXPECT_EQ(static_cast<std::size_t>(y) * static_cast<std::size_t>(c.width), map.size());
        map.insert(map.end(), row, row + c.width);
    });
    for (int y = 0; y < c.height; y += block) meter.add(&c.a[static_cast<std::size_t>(3 * y * c.width)], &c.b[static_cast<std::size_t>(3 * y * c.width)], std::min(block, c.height - y));
    EXPECT_EQ(map.size(), c.a.size() / 3);
    return map;
}
double mean(const std::vector<float>& values) {
    double sum = 0;
    for (const float v : values) sum += v;
    return sum / static_cast<double>(values.size());
}

TEST(Flip, EqualsAnotherImplementation) {
    const Colors c = sample_colors();
    const auto map = flip_map(c, {});
    EXPECT_NEAR(mean(map), 0.158101071, 1e-6);
    EXPECT_NEAR(map[12 * 56 + 15], 0.4146256, 1e-5);
    EXPECT_NEAR(map[20 * 56 + 42], 0.6316186, 1e-5);
    EXPECT_EQ(map[0], 0);
    FlipOptions far;
    far.pixels_per_degree = 30;
    EXPECT_NEAR(mean(flip_map(c, far)), 0.148555441, 1e-6);
}

TEST(Flip, OfHighRangeEqualsAnotherImplementation) {
    Colors c = sample_colors();
    LuminanceMeter luminance;
    for (float* v : {c.a.data(), c.b.data()})
        for (std::size_t i = 0; i < c.a.size(); ++i) v[i] *= v[i] * 40;
    luminance.add(c.a.data(), c.a.size() / 3);
    FlipOptions options;
    choose_exposures(luminance.largest(), luminance.median(), options);
    EXPECT_NEAR(options.start, -3.7326808, 1e-4);
    EXPECT_NEAR(options.stop, -2.7561745, 1e-4);
    EXPECT_EQ(options.exposures, 2);
    EXPECT_NEAR(mean(flip_map(c, options)), 0.185902306, 2e-5);
}

TEST(Flip, BlackAgainstWhite) {
    // No edges: HyAB is 100, 100^0.7 is above 0.4 of the largest, 41.2760984: 0.95 + (25.1188643 - 16.5104394) / 24.7656590 * 0.05.
    const Colors c{30, 30, std::vector<float>(2700, 0.0f), std::vector<float>(2700, 1.0f)};
    for (const float v : flip_map(c, {})) ASSERT_NEAR(v, 0.967379762, 1e-5);
}

TEST(Flip, LawsOfADifference) {
    const Colors c = sample_colors();
    const auto map = flip_map(c, {});
    for (const float v : map) EXPECT_TRUE(v >= 0 && v <= 1) << v;
    EXPECT_EQ(mean(flip_map({c.width, c.height, c.a, c.a}, {})), 0);
    const auto other = flip_map({c.width, c.height, c.b, c.a}, {});
    for (std::size_t i = 0; i < map.size(); ++i) ASSERT_NEAR(map[i], other[i], 1e-5) << "it is symmetric";
    EXPECT_EQ(flip_map(c, {}, 1), map) << "blocks of rows do not matter";
    EXPECT_EQ(flip_map(c, {}, 40), map);
}

TEST(Flip, ThreadsDoNotChangeTheMapNorSsim) {
    Colors c{300, 70, {}, {}};
    std::mt19937 random(2);
    for (int i = 0; i < 3 * c.width * c.height; ++i) c.a.push_back(static_cast<float>(random() % 100) / 100), c.b.push_back(static_cast<float>(random() % 100) / 100);
    const auto both = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        std::vector<double> values;
        for (const float v : flip_map(c, {})) values.push_back(v);
        SsimMeter meter(3 * c.width, [&](int, const double* row) { values.insert(values.end(), row, row + 3 * c.width - 10); });
        meter.add(c.a.data(), c.b.data(), c.height);
        return values;
    };
    EXPECT_EQ(both(1), both(4));
}

TEST(Ssim, EqualsAnotherImplementation) {
    const Colors c = sample_colors();
    std::vector<float> a, b;
    for (std::size_t i = 0; i < c.a.size(); i += 3) a.push_back(0.299f * c.a[i] + 0.587f * c.a[i + 1] + 0.114f * c.a[i + 2]), b.push_back(0.299f * c.b[i] + 0.587f * c.b[i + 1] + 0.114f * c.b[i + 2]);
    for (const int block : {1, 7, 40}) {
        double sum = 0;
        std::size_t n = 0;
        SsimMeter meter(c.width, [&](int y, const double* row) {
            EXPECT_TRUE(y >= 5 && y < 35);
            for (int x = 0; x < c.width - 10; ++x, ++n) sum += row[x];
        });
        for (int y = 0; y < c.height; y += block) meter.add(&a[static_cast<std::size_t>(y * c.width)], &b[static_cast<std::size_t>(y * c.width)], std::min(block, c.height - y));
        ASSERT_EQ(n, 46u * 30u);
        EXPECT_NEAR(sum / static_cast<double>(n), 0.823556506021, 1e-7);
    }
}

TEST(Ssim, OfFlatPicturesFollowsTheFormula) {
    // Without variance only the means are left: (2 m n + c1) / (m m + n n + c1).
    const std::vector<float> a(400, 0.25f), b(400, 0.75f);
    SsimMeter meter(20, [](int, const double* row) {
        for (int x = 0; x < 10; ++x) ASSERT_NEAR(row[x], (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4), 1e-12);
    });
    meter.add(a.data(), b.data(), 20);
    SsimMeter same(20, [](int, const double* row) {
        for (int x = 0; x < 10; ++x) ASSERT_EQ(row[x], 1);
    });
    same.add(a.data(), a.data(), 20);
}

// ---- files ------------------------------------------------------------------------------------------------------------

ImageLayer noise(int width, int height, const char* type) {
    ImageLayer l = make_layer("", width, height, {"R", "G", "B"}, {type, type, type});
    std::mt19937 random(3);
    for (float& v : l.values) v = static_cast<float>(random() % 256) / 255;
    if (type == std::string("uint8")) l.space = "sRGB";
    return l;
}

TEST(ImageDecoder, LargeWholeNumbersAreNotRoundedAway) {
    const test::TemporaryFolder t;
    ImageLayer l = make_layer("", 4, 4, {"patch.I", "Z"}, {"uint32", "float"});
    l.at(1, 1, "patch.I") = 16777216;
    write_layers(t / "a.exr", {l});
    l.at(1, 1, "patch.I") = 16777218;
    write_layers(t / "b.exr", {l});
    const ImageDiff d = diff_images(t / "a.exr", t / "b.exr", {});
    EXPECT_EQ(d.verdict, DiffVerdict::fail);
    EXPECT_EQ(d.max, 2) << "not a fraction of 2^32";
}

TEST(ImageDecoder, ReadsAfterThisProcessHasWrittenSideBySide) {
    const test::TemporaryFolder t;
    Image picture;
    picture.width = picture.height = 512;
    picture.pixels.assign(4 * 512 * 512, 0.25f);
    image_module().threads(4);  // OpenEXR's, which the next file starts
    write_image(t / "a.exr", picture, {});
    ImageLimits limits;
    limits.threads = 4, limits.seconds = 20;  // as many: the decoder used to wait for those that it did not have
    ImageDecoder file(t / "a.exr", limits);
    file.open();
    file.begin(0, file.most_rows(0), RowKind::floats);
    EXPECT_NO_THROW(file.block(0));
}

TEST(ImageDecoder, RefusesWhatIsTooLarge) {
    const test::TemporaryFolder t;
    write_layers(t / "a.png", {noise(64, 64, "uint8")});
    DiffRequest request;
    request.image.pixels = 4095;
    EXPECT_THROW(diff_images(t / "a.png", t / "a.png", request), Error);
    request.image.pixels = 4096;
    EXPECT_EQ(diff_images(t / "a.png", t / "a.png", request).verdict, DiffVerdict::pass);
    std::string bytes = read_all(t / "a.png");
    bytes[16] = 0x00, bytes[17] = 0x01, bytes[20] = 0x00, bytes[21] = 0x01;  // 65600 x 65600
    write_all(t / "b.png", bytes);
    try {
        diff_images(t / "a.png", t / "b.png", {});
        ADD_FAILURE() << "was read";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::io);
        EXPECT_NE(std::string(e.what()).find("b.png"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("65600 x 65600"), std::string::npos) << e.what();
    }
}

std::string damaged(std::string bytes, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    switch (below(5)) {
        case 0:
            for (std::size_t k = below(30) + 1; k > 0; --k) bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8));
            return bytes;
        case 1: return bytes.substr(0, below(bytes.size()));
        case 2:
            for (std::size_t k = below(6) + 1; k > 0; --k) bytes[below(std::min<std::size_t>(bytes.size(), 400))] = static_cast<char>(random());
            return bytes;
        case 3: return bytes.substr(0, below(bytes.size())) + bytes.substr(below(bytes.size()));
        default: {
            const std::size_t at = below(std::min<std::size_t>(bytes.size(), 500));
            for (std::size_t k = at; k < std::min(at + 4, bytes.size()); ++k) bytes[k] = random() % 2 ? '\xff' : '\0';
            return bytes;
        }
    }
}

TEST(ImageDecoder, DamagedFilesAreErrorsAndNothingWorse) {
    const test::TemporaryFolder t;
    std::mt19937 random(11);
    int refused = 0;
    for (const auto& [name, type] : {std::pair{"exr", "half"}, {"png", "uint8"}, {"tif", "uint8"}, {"jpg", "uint8"}, {"tga", "uint8"}}) {
        const std::string a = t / ("a." + std::string(name)), b = t / ("b." + std::string(name));
        write_layers(a, {noise(40, 30, type)});
        const std::string bytes = read_all(a);
        for (int k = 0; k < 13; ++k) {
            write_all(b, damaged(bytes, random));
            const auto start = std::chrono::steady_clock::now();
            try {
                EXPECT_NE(diff_images(a, b, {}).verdict, DiffVerdict::unreadable);
            } catch (const Error& e) {
                EXPECT_EQ(e.kind(), ErrorKind::io) << e.what();
                EXPECT_NE(std::string(e.what()).find("b."), std::string::npos) << e.what();
                ++refused;
            }
            EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20)) << name << " " << k;
        }
    }
    EXPECT_GT(refused, 20);
}

TEST(ImageHeader, AnyBytesEndInAHeaderOrAnError) {
    const test::TemporaryFolder t;
    std::mt19937 random(5);
    for (const auto& [name, type] : {std::pair{"exr", "half"}, {"png", "uint8"}, {"tif", "uint8"}, {"jpg", "uint8"}, {"tga", "uint8"}, {"bmp", "uint8"}, {"ppm", "uint8"}}) {
        const std::string path = t / ("a." + std::string(name));
        write_layers(path, {noise(40, 30, type)});
        const std::string bytes = read_all(path);
        EXPECT_EQ(read_image_header(bytes, bytes.size(), path).pixels, 1200u) << name;
        for (int k = 0; k < 2000; ++k) {
            const std::string some = damaged(bytes, random);
            try {
                const ImageHeader h = read_image_header(some, some.size(), path);
                EXPECT_GT(h.pixels, 0u);
                EXPECT_GT(h.row, 0u);
            } catch (const Error& e) {
                EXPECT_EQ(e.kind(), ErrorKind::io);
            }
        }
    }
}

}  // namespace
}  // namespace isoparm
