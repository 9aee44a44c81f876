#include "drawing/paper.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "drawing/text_cairo.h"
#include "io/atomic_file.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

std::string extension_of(const std::string& path) {
    std::string e = fs::path(path).extension().string();
    std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return std::tolower(c); });
    return e;
}
/// TeX takes no name with one of its special characters or spaces: these become their numbers, "50x25" of "50%".
std::string raster_path(const std::string& path) {
    std::string name;
    for (const char c : fs::path(path).stem().string()) {
        const auto byte = static_cast<unsigned char>(c);
        if (std::isalnum(byte) || byte >= 0x80 || c == '-' || c == '_' || c == '.' || c == '+') {
            name += c;
        } else {
            char number[8];
            std::snprintf(number, sizeof number, "x%02x", byte);
            name += number;
        }
    }
    return (fs::path(path).parent_path() / (name + "-raster.png")).string();
}

// ---- opacities ----------------------------------------------------------------------------------------------------
/// Mean luminance of the raster at some points; what is transparent counts as white paper.
double under(const std::vector<Vec2>& points, const DrawnPart& part, const Image& raster) {
    double sum = 0;
    int n = 0;
    for (const Vec2& p : points) {
        const double x = std::floor(p.x) + part.x, y = std::floor(p.y) + part.y;
        if (!(x >= 0 && y >= 0 && x < raster.width && y < raster.height)) continue;
        const float* c = raster.at(static_cast<int>(x), static_cast<int>(y));
        sum += luminance({c[0], c[1], c[2]}) + (1 - c[3]);
        ++n;
    }
    return n > 0 ? std::clamp(sum / n, 0.0, 1.0) : 1;
}
std::vector<Vec2> points_of(const Polyline& line) {
    std::vector<Vec2> points = line.points;
    for (const auto& other : line.more) points.insert(points.end(), other.begin(), other.end());
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i)  // long straight lines have few points of their own
        for (const double t : {0.25, 0.5, 0.75})
            points.push_back({(1 - t) * line.points[i].x + t * line.points[i + 1].x, (1 - t) * line.points[i].y + t * line.points[i + 1].y});
    return points;
}
std::vector<Vec2> points_of(const Filled& area) { return area.outline; }
std::vector<Vec2> points_of(const Text& text) {
    const TextBox box = text_box(text.text, text.size);
    std::vector<Vec2> points;
    for (const double s : {0.1, 0.3, 0.5, 0.7, 0.9})
        for (const double t : {0.2, 0.5, 0.8})
            points.push_back({text.at.x + (1 - s) * box.left + s * box.right, text.at.y + (1 - t) * box.top + t * box.bottom});
    return points;
}

/// The opacity that makes of sRGB values what `opacity` makes of light, over a ground of that luminance.
double srgb_opacity(const Color& color, double opacity, double ground) {
    const double own = luminance(color), from = srgb_from_linear(ground), to = srgb_from_linear(std::clamp(own, 0.0, 1.0));
    if (opacity <= 0 || opacity >= 1 || std::fabs(to - from) < 0.02) return opacity;
    return std::clamp((srgb_from_linear(opacity * own + (1 - opacity) * ground) - from) / (to - from), 0.0, 1.0);
}

void set_opacities(PaperFigure& figure) {
    for (DrawnPart& part : figure.parts)
        for (DrawingItem& item : part.drawing) {
            if (item.opacity >= 1) continue;
            const auto points = std::visit([](const auto& shape) { return points_of(shape); }, item.shape);
            item.opacity = srgb_opacity(item.color, item.opacity, under(points, part, figure.raster));
        }
}

}  // namespace

std::string decimal(double x, const char* format) {
    char text[64];
    std::snprintf(text, sizeof text, format, x);
    std::string s = text;
    s.erase(s.find_last_not_of('0') + 1);
    if (s.back() == '.') s.pop_back();
    return s == "-0" ? "0" : s;
}

bool is_paper(const std::string& path) {
    const std::string e = extension_of(path);
    return e == ".pdf" || e == ".svg" || e == ".tex";
}

std::vector<std::string> paper_files(const std::string& path) {
    if (extension_of(path) == ".tex") return {path, raster_path(path)};
    return {path};
}

void write_paper(const std::string& path, PaperFigure figure, const Metadata& metadata) {
    set_opacities(figure);
    const std::string e = extension_of(path);
    std::string bytes;
    if (e == ".tex") {
        const std::string raster = raster_path(path);
        write_image(raster, figure.raster, metadata);
        bytes = tikz_text(figure, fs::path(raster).filename().string());
    } else {
        bytes = e == ".pdf" ? pdf_page(figure) : svg_text(figure);
    }
    write_atomically(path, [&](std::ostream& out) { out.write(bytes.data(), static_cast<std::streamsize>(bytes.size())); });
}

}  // namespace isoparm
