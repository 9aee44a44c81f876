#include "diff/diff_selftest.h"

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "diff/diff_report.h"
#include "error.h"
#include "image/image_layers.h"

namespace isoparm {
namespace {

using Layers = std::vector<ImageLayer>;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

/// Colours with depth and places of patches, and a second part of normals; every value is a half float and not 0.
Layers sample_layers() {
    ImageLayer beauty = make_layer("beauty", 48, 32, {"R", "G", "B", "A", "Z", "patch.I", "uv.U", "uv.V"}, {"half", "half", "half", "half", "float", "uint32", "float", "float"});
    ImageLayer normals = make_layer("normals", 48, 32, {"N.X", "N.Y", "N.Z"}, {"half", "half", "half"});
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 48; ++x) {
            beauty.at(x, y, "R") = static_cast<float>(x + 1) / 64, beauty.at(x, y, "G") = static_cast<float>(y + 1) / 64, beauty.at(x, y, "B") = static_cast<float>((x * 5 + y * 3) % 16 + 1) / 32;
            beauty.at(x, y, "A") = 1, beauty.at(x, y, "Z") = 4 + static_cast<float>(x) / 8, beauty.at(x, y, "patch.I") = static_cast<float>(x / 16);
            beauty.at(x, y, "uv.U") = static_cast<float>(x % 16) / 16, beauty.at(x, y, "uv.V") = static_cast<float>(y) / 32;
            normals.at(x, y, "N.X") = 0.25f, normals.at(x, y, "N.Y") = static_cast<float>(x) / 64, normals.at(x, y, "N.Z") = 0.5f;
        }
    return {beauty, normals};
}

/// Of bytes, as a PNG holds.
Layers sample_bytes() {
    ImageLayer l = make_layer("", 48, 32, {"R", "G", "B", "A"}, {"uint8", "uint8", "uint8", "uint8"});
    l.space = "sRGB";
    for (std::size_t i = 0; i < l.values.size(); ++i) l.values[i] = static_cast<float>((i * 37) % 200 + 20) / 255;
    return {l};
}

ImageLayer shifted(const ImageLayer& l, int dx, int dy) {
    ImageLayer moved = l;
    const int w = l.part.data.width, h = l.part.data.height;
    const std::size_t n = l.part.channels.size();
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (std::size_t c = 0; c < n; ++c)
                moved.values[(static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x)) * n + c] =
                    l.values[(static_cast<std::size_t>((y + dy) % h) * static_cast<std::size_t>(w) + static_cast<std::size_t>((x + dx) % w)) * n + c];
    return moved;
}

ImageLayer resized(ImageLayer l, int width, int height) {
    l.part.data = l.part.display = {0, 0, width, height};
    l.values.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * l.part.channels.size(), 0.5f);
    return l;
}

ImageLayer without(const ImageLayer& l, const std::string& channel) {
    ImageLayer less = make_layer(l.part.name, l.part.data.width, l.part.data.height, {}, {});
    less.space = l.space;
    std::vector<std::size_t> kept;
    for (std::size_t c = 0; c < l.part.channels.size(); ++c)
        if (l.part.channels[c] != channel) kept.push_back(c), less.part.channels.push_back(l.part.channels[c]), less.part.types.push_back(l.part.types[c]);
    for (std::size_t i = 0; i < l.values.size(); i += l.part.channels.size())
        for (const std::size_t c : kept) less.values.push_back(l.values[i + c]);
    return less;
}

void every(ImageLayer& l, const std::string& channel, const std::function<float(float)>& f) {
    for (int y = 0; y < l.part.data.height; ++y)
        for (int x = 0; x < l.part.data.width; ++x) l.at(x, y, channel) = f(l.at(x, y, channel));
}

class Trials {
public:
    explicit Trials(const std::string& folder) : folder_(folder) {}
    /// The sample against the sample changed.
    void run(const std::string& what, const char* expected, const std::string& extension, Layers layers, const std::function<void(Layers&)>& change, const DiffRequest& request = {}) {
        const std::string a = folder_ + "/a." + extension, b = folder_ + "/b." + extension;
        write_layers(a, layers);
        change(layers);
        write_layers(b, layers);
        compare(what + " (" + extension + ")", expected, a, b, request);
    }
    void compare(const std::string& what, const char* expected, const std::string& a, const std::string& b, const DiffRequest& request = {}) {
        std::string found = "error";
        try {
            found = verdict_name(diff_images(a, b, request).verdict);
        } catch (const Error& e) {
            if (e.kind() != ErrorKind::io) throw;
        }
        all.push_back({what, expected, found});
    }
    std::vector<DiffTrial> all;

private:
    std::string folder_;
};

void change_values(Trials& t) {
    const auto sample = [](Layers&) {};
    t.run("nothing", "pass", "exr", sample_layers(), sample);
    t.run("nothing", "pass", "png", sample_bytes(), sample);
    for (const auto& [x, y] : {std::pair{0, 0}, {47, 0}, {0, 31}, {47, 31}, {20, 11}})
        t.run("one pixel, at " + std::to_string(x) + "," + std::to_string(y), "fail", "exr", sample_layers(), [x = x, y = y](Layers& l) { l[0].at(x, y, "G") += 1.0f / 256; });
    for (const char* c : {"R", "G", "B", "A", "Z", "patch.I", "uv.U", "uv.V"})
        t.run(std::string("one pixel of ") + c, "fail", "exr", sample_layers(), [=](Layers& l) { l[0].at(30, 7, c) += std::string(c) == "patch.I" ? 1.0f : 0.125f; });
    t.run("one pixel of the second part", "fail", "exr", sample_layers(), [](Layers& l) { l[1].at(3, 4, "N.Z") += 0.125f; });
    t.run("one step of one byte", "fail", "png", sample_bytes(), [](Layers& l) { l[0].at(9, 9, "B") += 1.0f / 255; });
    t.run("one step of one alpha", "fail", "png", sample_bytes(), [](Layers& l) { l[0].at(9, 9, "A") += 1.0f / 255; });
    DiffRequest tolerant;
    tolerant.limits.fail.value = tolerant.limits.warn.value = 0.25;
    t.run("one pixel by less than the limit", "pass", "exr", sample_layers(), [](Layers& l) { l[0].at(9, 9, "R") += 0.125f; }, tolerant);
    t.run("one pixel by more than the limit", "fail", "exr", sample_layers(), [](Layers& l) { l[0].at(9, 9, "R") += 0.5f; }, tolerant);
    t.run("the sign of a zero", "pass", "exr", sample_layers(), [](Layers& l) { every(l[1], "N.Y", [](float v) { return v == 0 ? -0.0f : v; }); });
    t.run("brighter by one part in a hundred", "fail", "exr", sample_layers(), [](Layers& l) { every(l[0], "R", [](float v) { return v * 1.01f; }); });
    t.run("gamma of 1.1", "fail", "exr", sample_layers(), [](Layers& l) { every(l[0], "G", [](float v) { return std::pow(v, 1 / 1.1f); }); });
    t.run("clipped at one half", "fail", "exr", sample_layers(), [](Layers& l) { every(l[0], "R", [](float v) { return std::min(v, 0.5f); }); });
    t.run("negative", "fail", "exr", sample_layers(), [](Layers& l) { every(l[1], "N.X", [](float v) { return -v; }); });
    t.run("black", "fail", "png", sample_bytes(), [](Layers& l) { l[0].values.assign(l[0].values.size(), 0); });
    t.run("moved by a pixel to the left", "fail", "exr", sample_layers(), [](Layers& l) { l[0] = shifted(l[0], 1, 0); });
    t.run("moved by a pixel up", "fail", "png", sample_bytes(), [](Layers& l) { l[0] = shifted(l[0], 0, 1); });
    t.run("red and green swapped", "fail", "exr", sample_layers(), [](Layers& l) { std::swap(l[0].part.channels[0], l[0].part.channels[1]); });
}

void change_to_nonfinite(Trials& t) {
    for (const auto& [name, value] : {std::pair{"NaN", kNan}, {"Inf", kInf}, {"-Inf", -kInf}}) {
        const auto put = [value = value](Layers& l) { l[0].at(12, 20, "Z") = value; };
        Layers with = sample_layers();
        put(with);
        t.run(std::string(name) + " in the new image", "fail", "exr", sample_layers(), put);
        t.run(std::string(name) + " in the reference", "fail", "exr", with, [](Layers& l) { l[0].at(12, 20, "Z") = 1; });
        t.run(std::string(name) + " in both", "fail", "exr", with, [](Layers&) {});
        DiffRequest lenient;  // percentages and high limits do not let it pass
        lenient.limits.fail = lenient.limits.warn = {1e30, 100, 1e30};
        t.run(std::string(name) + " in the new image, with every limit open", "fail", "exr", sample_layers(), put, lenient);
        DiffRequest allowed;
        allowed.limits.allow_nonfinite = true;
        t.run(std::string(name) + " in both, allowed", "pass", "exr", with, [](Layers&) {}, allowed);
        t.run(std::string(name) + " in the new image, allowed", "fail", "exr", sample_layers(), put, allowed);
    }
}

void change_shape(Trials& t) {
    t.run("a row less", "not_comparable", "png", sample_bytes(), [](Layers& l) { l[0] = resized(l[0], 48, 31); });
    t.run("a column more", "not_comparable", "png", sample_bytes(), [](Layers& l) { l[0] = resized(l[0], 49, 32); });
    t.run("turned", "not_comparable", "png", sample_bytes(), [](Layers& l) { l[0] = resized(l[0], 32, 48); });
    t.run("without alpha", "not_comparable", "png", sample_bytes(), [](Layers& l) { l[0] = without(l[0], "A"); });
    t.run("the data window elsewhere", "not_comparable", "exr", sample_layers(), [](Layers& l) { l[0].part.data.x += 1; });
    t.run("the display window larger", "not_comparable", "exr", sample_layers(), [](Layers& l) {
        for (ImageLayer& layer : l) layer.part.display.width += 8;
    });
    t.run("a channel missing", "not_comparable", "exr", sample_layers(), [](Layers& l) { l[0] = without(l[0], "Z"); });
    t.run("a channel renamed", "not_comparable", "exr", sample_layers(), [](Layers& l) { l[1].part.channels[0] = "M.X"; });
    t.run("a part missing", "not_comparable", "exr", sample_layers(), [](Layers& l) { l.pop_back(); });
    t.run("a part more", "not_comparable", "exr", sample_layers(), [](Layers& l) { l.push_back(l[1]), l.back().part.name = "more"; });
    t.run("a part renamed", "not_comparable", "exr", sample_layers(), [](Layers& l) { l[1].part.name = "others"; });
    t.run("parts in another order", "pass", "exr", sample_layers(), [](Layers& l) { std::swap(l[0], l[1]); });
    t.run("the colour space", "not_comparable", "png", sample_bytes(), [](Layers& l) { l[0].space = "Linear"; });
}

void damage_files(Trials& t, const std::string& folder) {
    for (const char* extension : {"exr", "png"}) {
        const std::string a = folder + "/a." + extension, b = folder + "/b." + extension, kind = std::string(" (") + extension + ")";
        write_layers(a, extension == std::string("exr") ? sample_layers() : sample_bytes());
        std::ifstream in(a, std::ios::binary);
        std::ostringstream all;
        all << in.rdbuf();
        const std::string bytes = all.str();
        const auto with = [&](const std::string& what, const std::string& text) {
            std::ofstream(b, std::ios::binary) << text;
            t.compare(what + kind, "error", a, b);
        };
        with("no bytes", "");
        with("half of the file", bytes.substr(0, bytes.size() / 2));
        with("only its header", bytes.substr(0, 40));
        with("text", "this is no image");
        std::string header = bytes;
        header[0] = static_cast<char>(header[0] ^ 1);
        with("its first byte", header);
        with("a file of another format", extension == std::string("exr") ? "\x89PNG\r\n\x1a\n" + bytes : "\x76\x2f\x31\x01" + bytes);
    }
    t.compare("the file removed (exr)", "error", folder + "/a.exr", folder + "/none.exr");
}

}  // namespace

std::vector<DiffTrial> diff_selftest(const std::string& folder) {
    Trials t(folder);
    change_values(t);
    change_to_nonfinite(t);
    change_shape(t);
    damage_files(t, folder);
    return std::move(t.all);
}

}  // namespace isoparm
