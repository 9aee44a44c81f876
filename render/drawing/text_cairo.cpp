#include "drawing/text_cairo.h"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <pango/pangocairo.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "drawing/math_symbols.h"
#include "error.h"
#include "picture/palette.h"
#include "scene/suggest.h"

namespace isoparm {
namespace {

// Times as papers print it, with Greek; what comes later is for machines without.
constexpr const char* kFamilies =
    "STIXGeneral, STIX, STIX Two Text, FreeSerif, TeX Gyre Termes, Times New Roman, Liberation Serif, DejaVu Serif, "
    "serif";

template <auto release> struct Release {
    template <class T> void operator()(T* p) const { release(p); }
};
using Target = std::unique_ptr<cairo_surface_t, Release<cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Release<cairo_destroy>>;
using Layout = std::unique_ptr<PangoLayout, Release<g_object_unref>>;
using Font = std::unique_ptr<PangoFontDescription, Release<pango_font_description_free>>;
using FontOptions = std::unique_ptr<cairo_font_options_t, Release<cairo_font_options_destroy>>;

void check(cairo_t* c) {
    if (const auto status = cairo_status(c); status != CAIRO_STATUS_SUCCESS)
        throw std::runtime_error(std::string("Cairo failed: ") + cairo_status_to_string(status));
}

/// Above letters that reach into accents, as capitals do in fonts that have places for accents on small letters only.
void raise_accents(PangoLayout* layout, const std::string& text, double size, bool italic) {
    constexpr double kGap = 0.05, kSlant = 0.2;
    PangoRectangle letter{};
    double pen = 0, letter_pen = 0, raised = 0;  // raised: by what the accent below was
    for (GSList* r = pango_layout_get_line(layout, 0)->runs; r; r = r->next) {
        const auto* item = static_cast<PangoGlyphItem*>(r->data);
        for (int i = 0; i < item->glyphs->num_glyphs; ++i) {
            PangoGlyphInfo& glyph = item->glyphs->glyphs[i];
            PangoRectangle ink;
            pango_font_get_glyph_extents(item->item->analysis.font, glyph.glyph, &ink, nullptr);
            if (tex_of_accent(character_at(text, static_cast<std::size_t>(item->item->offset + item->glyphs->log_clusters[i]))).empty()) {
                letter = ink, letter_pen = pen, raised = 0;
            } else if (ink.height > 0 && ink.y < 0) {  // it stands above the letter
                const double bottom = glyph.geometry.y_offset - raised + ink.y + ink.height;  // downward
                raised += std::max(0.0, bottom - (letter.y - kGap * size * PANGO_SCALE));
                if (raised > 0) {
                    const double middle = letter_pen + letter.x + 0.5 * letter.width + (italic ? kSlant * 0.5 * letter.height : 0);
                    glyph.geometry.y_offset -= static_cast<int>(std::lround(raised));
                    glyph.geometry.x_offset = static_cast<int>(std::lround(middle - pen - ink.x - 0.5 * ink.width));
                }
            }
            pen += glyph.geometry.width;
        }
    }
}

/// Outlines of the letters, not fitted to the pixels: a text looks alike at every size and place.
Layout layout_of(cairo_t* c, const TextRun& run, double size) {
    Layout layout(pango_cairo_create_layout(c));
    const FontOptions options(cairo_font_options_create());
    cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(pango_layout_get_context(layout.get()), options.get());
    pango_context_set_round_glyph_positions(pango_layout_get_context(layout.get()), FALSE);
    pango_layout_context_changed(layout.get());
    const Font font(pango_font_description_new());
    pango_font_description_set_family_static(font.get(), kFamilies);
    pango_font_description_set_style(font.get(), run.italic ? PANGO_STYLE_ITALIC : PANGO_STYLE_NORMAL);
    pango_font_description_set_weight(font.get(), run.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
    pango_font_description_set_absolute_size(font.get(), size * run.scale * PANGO_SCALE);
    pango_layout_set_font_description(layout.get(), font.get());
    pango_layout_set_single_paragraph_mode(layout.get(), TRUE);
    pango_layout_set_text(layout.get(), run.text.c_str(), static_cast<int>(run.text.size()));
    raise_accents(layout.get(), run.text, size * run.scale, run.italic);
    return layout;
}

/// What to do with each run where it stands, and with the bar over what is under a root.
struct AddToPath {
    void run(cairo_t* c, PangoLayoutLine* line, const TextRun&, double) const { pango_cairo_layout_line_path(c, line); }
    void bar(cairo_t* c, const TextBox& b) const {
        // Twice: it overlaps with the sign, whose outline may run the other way round, and once each would make a hole.
        for (int i = 0; i < 2; ++i) cairo_rectangle(c, b.left, b.top, b.right - b.left, b.bottom - b.top);
    }
};

constexpr double kBarGap = 0.10, kBarWidth = 0.045, kBarEnd = 0.04, kBarJoin = 0.03;  // ems of the radical sign

/// The top of runs first <= i < last over the base line of the text, with bars of their own, in pixels upward.
double top_of(cairo_t* c, const MathText& text, std::size_t first, std::size_t last, double size) {
    double top = 0;
    for (std::size_t i = first; i < last; ++i) {
        const Layout layout = layout_of(c, text[i], size);
        PangoRectangle ink;
        pango_layout_line_get_extents(pango_layout_get_line_readonly(layout.get(), 0), &ink, nullptr);
        top = std::max(top, text[i].rise * size - static_cast<double>(ink.y) / PANGO_SCALE);
        if (text[i].covers > 0) top = std::max(top, top_of(c, text, i + 1, i + 1 + text[i].covers, size) + (kBarGap + kBarWidth) * text[i].scale * size);
    }
    return top;
}

/// How much larger a radical sign has to be so that its bar is above what it covers.
double growth(cairo_t* c, const MathText& text, std::size_t sign, double size) {
    const TextRun& run = text[sign];
    if (run.covers == 0) return 1;
    const Layout layout = layout_of(c, run, size);
    PangoRectangle ink;
    pango_layout_line_get_extents(pango_layout_get_line_readonly(layout.get(), 0), &ink, nullptr);
    const double has = -static_cast<double>(ink.y) / PANGO_SCALE, em = run.scale * size;
    return std::max(1.0, (top_of(c, text, sign + 1, sign + 1 + run.covers, size) - run.rise * size + (kBarGap + kBarWidth) * em) / has);
}

/// Puts the outlines on the context's path, from (x,y) on, or does something else with each run where it stands.
template <class Use = AddToPath>
TextBox set(cairo_t* c, const MathText& text, double size, double x, double y, Use use = {}) {
    TextBox box{INFINITY, INFINITY, -INFINITY, -INFINITY, 0};
    double pen = x, subscript = x, furthest = x;
    bool slanted = false;
    struct Root {
        std::size_t last;     // run
        double left, top, em;  // of its bar
    };
    std::vector<Root> roots;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const TextRun& run = text[i];
        if (run.begins == TextRun::Begins::over_subscript)
            pen = subscript + 0.06 * size;
        else
            pen = std::max(pen, furthest);
        if (run.begins == TextRun::Begins::subscript)
            subscript = pen;
        else if (slanted && !run.italic)
            pen += 0.04 * size * run.scale;  // a slanted letter leans over what follows
        slanted = run.italic;
        pen += run.before * size;
        const double grown = growth(c, text, i, size);
        const Layout layout = layout_of(c, run, grown * size);
        if (pango_layout_get_unknown_glyphs_count(layout.get()) > 0)
            throw Error(ErrorKind::io,
                        "no font was found that has all letters of " + quoted(run.text) +
                            " in a label, expected one; install one that has (Debian, Ubuntu: apt-get install fonts-stix for mathematics, fonts-noto for other scripts), or write it with other letters");
        PangoLayoutLine* line = pango_layout_get_line_readonly(layout.get(), 0);
        PangoRectangle ink, logical;
        pango_layout_line_get_extents(line, &ink, &logical);
        const double base = y - run.rise * size, unit = 1.0 / PANGO_SCALE;
        if (ink.width > 0 && ink.height > 0) {
            box.left = std::min(box.left, pen + unit * ink.x);
            box.right = std::max(box.right, pen + unit * (ink.x + ink.width));
            box.top = std::min(box.top, base + unit * ink.y);
            box.bottom = std::max(box.bottom, base + unit * (ink.y + ink.height));
        }
        cairo_move_to(c, pen, base);
        use.run(c, line, run, grown);
        if (run.covers > 0) roots.push_back({i + run.covers, pen + unit * (ink.x + ink.width) - kBarJoin * run.scale * size, base + unit * ink.y, run.scale * size});
        pen += unit * logical.width;
        furthest = std::max(furthest, pen);
        for (; !roots.empty() && roots.back().last == i; roots.pop_back()) {
            const Root& r = roots.back();
            furthest = std::max(furthest, box.right) + kBarEnd * r.em;
            use.bar(c, {r.left, r.top, furthest, r.top + kBarWidth * r.em, 0});
            box.right = std::max(box.right, furthest);
        }
    }
    box.advance = furthest - x;
    if (!(box.left <= box.right)) box.left = box.right = x, box.top = box.bottom = y;
    check(c);
    return box;
}

/// The same where the text stands.
template <class Use = AddToPath> void set(cairo_t* c, const Text& text, Use use = {}) {
    cairo_save(c);
    cairo_translate(c, text.at.x, text.at.y);
    if (text.turned) cairo_rotate(c, -std::numbers::pi / 2);
    set(c, text.text, text.size, 0, 0, use);
    cairo_restore(c);
}

/// Draws the path as that line is drawn.
void stroke(cairo_t* c, const Polyline& line) {
    cairo_set_line_width(c, line.width);
    cairo_set_line_cap(c, line.round ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
    cairo_set_dash(c, line.dash.data(), static_cast<int>(line.dash.size()), 0);
    cairo_stroke(c);
}

void put_shape(cairo_t* c, const Polyline& line) {
    cairo_new_path(c);
    for (const Vec2& p : line.points) cairo_line_to(c, p.x, p.y);
    for (const auto& other : line.more) {
        cairo_new_sub_path(c);
        for (const Vec2& p : other) cairo_line_to(c, p.x, p.y);
    }
    stroke(c, line);
}

struct Canvas {
    Target surface;
    Context context;
    explicit Canvas(int width = 1, int height = 1)
        : surface(cairo_image_surface_create(CAIRO_FORMAT_A8, width, height)), context(cairo_create(surface.get())) {
        check(context.get());
        cairo_set_antialias(context.get(), CAIRO_ANTIALIAS_BEST);
        cairo_set_tolerance(context.get(), 0.02);
    }
};

/// What `draw` paints on a canvas that shows the pixels of a box, as far as it is in the picture.
template <class Draw>
Coverage painted(double left, double top, double right, double bottom, int width, int height, Draw draw) {
    Coverage all;
    all.x0 = static_cast<int>(std::floor(std::clamp(left, 0.0, double(width))));
    all.y0 = static_cast<int>(std::floor(std::clamp(top, 0.0, double(height))));
    all.width = static_cast<int>(std::ceil(std::clamp(right, 0.0, double(width)))) - all.x0;
    all.height = static_cast<int>(std::ceil(std::clamp(bottom, 0.0, double(height)))) - all.y0;
    if (!(all.width > 0 && all.height > 0)) return {};
    const Canvas canvas(all.width, all.height);
    cairo_t* c = canvas.context.get();
    cairo_translate(c, -all.x0, -all.y0);
    draw(c);
    check(c);
    cairo_surface_flush(canvas.surface.get());
    const unsigned char* data = cairo_image_surface_get_data(canvas.surface.get());
    const int stride = cairo_image_surface_get_stride(canvas.surface.get());
    all.part.resize(static_cast<std::size_t>(all.width) * all.height);
    for (int y = 0; y < all.height; ++y)
        std::copy_n(data + static_cast<std::ptrdiff_t>(y) * stride, all.width,
                    &all.part[static_cast<std::size_t>(y) * all.width]);
    return all;
}

template <class Draw>
Coverage painted_about(const std::vector<Vec2>& points, double rim, int width, int height, Draw draw) {
    double left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;
    for (const Vec2& p : points) {
        left = std::min(left, p.x), right = std::max(right, p.x);
        top = std::min(top, p.y), bottom = std::max(bottom, p.y);
    }
    if (points.empty() || !std::isfinite(left + top + right + bottom)) return {};
    return painted(left - rim, top - rim, right + rim, bottom + rim, width, height, [&](cairo_t* c) {
        for (const Vec2& p : points) cairo_line_to(c, p.x, p.y);
        draw(c);
    });
}

}  // namespace

Coverage coverage(const Polyline& line, int width, int height) {
    std::vector<Vec2> all = line.points;
    for (const auto& other : line.more) all.insert(all.end(), other.begin(), other.end());
    return painted_about(all, line.width + 1, width, height, [&](cairo_t* c) { put_shape(c, line); });
}

Coverage coverage(const Filled& area, int width, int height) {
    return painted_about(area.outline, 1, width, height, [](cairo_t* c) {
        cairo_close_path(c);
        cairo_fill(c);
    });
}

Coverage coverage(const Text& text, double rim, int width, int height) {
    TextBox box = text_box(text.text, text.size);
    if (text.turned) box = {box.top, -box.right, box.bottom, -box.left, 0};
    const double around = rim + 2;
    return painted(text.at.x + box.left - around, text.at.y + box.top - around, text.at.x + box.right + around,
                   text.at.y + box.bottom + around, width, height, [&](cairo_t* c) {
                       set(c, text);
                       if (rim > 0) {
                           cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
                           cairo_set_line_width(c, 2 * rim);
                           cairo_stroke_preserve(c);
                       }
                       cairo_fill(c);
                   });
}

namespace {

cairo_status_t append(void* to, const unsigned char* data, unsigned int length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
}

void put_shape(cairo_t* c, const Filled& area) {
    cairo_new_path(c);
    for (const Vec2& p : area.outline) cairo_line_to(c, p.x, p.y);
    cairo_close_path(c);
    cairo_fill(c);
}
void put_shape(cairo_t* c, const Text& text) {
    cairo_new_path(c);
    set(c, text);
    cairo_fill(c);
}

}  // namespace

namespace {

void set_source(cairo_t* c, const Color& color, double opacity) { cairo_set_source_rgba(c, srgb_from_linear(color.x), srgb_from_linear(color.y), srgb_from_linear(color.z), opacity); }

void draw(cairo_t* c, const Drawing& drawing) {
    for (const DrawingItem& item : drawing) {
        set_source(c, item.color, item.opacity);
        std::visit([&](const auto& shape) { put_shape(c, shape); }, item.shape);
    }
}

/// For one page; no date.
Target pdf_surface(std::string& bytes, double width, double height, const std::string& title) {
    Target surface(cairo_pdf_surface_create_for_stream(append, &bytes, width, height));
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_TITLE, title.c_str());
    cairo_pdf_surface_set_metadata(surface.get(), CAIRO_PDF_METADATA_CREATE_DATE, "");
    return surface;
}
void finish(const Target& surface) {
    cairo_surface_finish(surface.get());
    if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) throw std::runtime_error("Cairo failed to write a drawing");
}

}  // namespace

std::string vector_file(const Drawing& drawing, double width, double height, VectorFormat format, const std::string& title) {
    std::string bytes;
    const bool pdf = format == VectorFormat::pdf;
    const Target surface = pdf ? pdf_surface(bytes, width, height, title) : Target(cairo_svg_surface_create_for_stream(append, &bytes, width, height));
    const Context context(cairo_create(surface.get()));
    cairo_t* c = context.get();
    cairo_set_source_rgb(c, 1, 1, 1);
    cairo_paint(c);
    draw(c, drawing);
    check(c);
    finish(surface);
    // Cairo numbers all its surfaces one after the other and writes that down.
    if (const auto at = pdf ? std::string::npos : bytes.find(" id=\"surface"); at != std::string::npos) bytes.erase(at, bytes.find('"', at + 5) + 1 - at);
    return bytes;
}

namespace {

std::uint32_t byte_of(double x) { return static_cast<std::uint32_t>(std::lround(255 * std::clamp(x, 0.0, 1.0))); }

/// The picture in Cairo's bytes: sRGB, premultiplied.
Target raster_surface(const Image& image) {
    const auto opaque = [&] {
        for (std::size_t i = 3; i < image.pixels.size(); i += 4)
            if (image.pixels[i] < 1) return false;
        return true;
    };
    Target surface(cairo_image_surface_create(opaque() ? CAIRO_FORMAT_RGB24 : CAIRO_FORMAT_ARGB32, image.width, image.height));
    if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) throw std::runtime_error("Cairo has no room for the picture");
    unsigned char* data = cairo_image_surface_get_data(surface.get());
    const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface.get());
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* in = image.at(x, y);
            const double alpha = std::clamp<double>(in[3], 0, 1);
            std::uint32_t pixel = byte_of(alpha) << 24;
            for (int k = 0; k < 3; ++k) {
                const double c = alpha > 0 && in[k] > 0 ? std::min(1.0, in[k] / alpha) : 0;
                pixel |= byte_of(alpha * srgb_from_linear(c)) << (16 - 8 * k);
            }
            std::copy_n(reinterpret_cast<const unsigned char*>(&pixel), 4, data + y * stride + 4 * x);
        }
    cairo_surface_mark_dirty(surface.get());
    return surface;
}

struct Show {
    void run(cairo_t* c, PangoLayoutLine* line, const TextRun&, double) const { pango_cairo_show_layout_line(c, line); }
    void bar(cairo_t* c, const TextBox& b) const {
        cairo_new_path(c);
        AddToPath().bar(c, b);
        cairo_fill(c);
    }
};

void put_text(cairo_t* c, const DrawingItem& item, const Text& text, bool outlines) {
    if (text.halo > 0) {
        set_source(c, text.rim, printed_halo(item.opacity));
        cairo_new_path(c);
        set(c, text);
        cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
        cairo_set_line_width(c, 2 * text.halo);
        cairo_set_dash(c, nullptr, 0, 0);
        cairo_stroke(c);
    }
    set_source(c, item.color, item.opacity);
    if (outlines) put_shape(c, text);
    else set(c, text, Show{});
}

}  // namespace

std::string pdf_page(const PaperFigure& figure) {
    const Image& image = figure.raster;
    std::string bytes;
    const Target raster = raster_surface(image), surface = pdf_surface(bytes, image.width / figure.pixels_per_point, image.height / figure.pixels_per_point, figure.title);
    const Context context(cairo_create(surface.get()));
    cairo_t* c = context.get();
    cairo_scale(c, 1 / figure.pixels_per_point, 1 / figure.pixels_per_point);
    cairo_set_source_surface(c, raster.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(c), CAIRO_FILTER_NEAREST);  // viewers do not smear the pixels
    cairo_paint(c);
    for (const DrawnPart& part : figure.parts) {
        cairo_save(c);
        cairo_rectangle(c, part.x, part.y, part.width, part.height);
        for (const auto& [x, y, width, height] : part.holes) {  // the other way round
            cairo_move_to(c, part.x + x, part.y + y);
            cairo_rel_line_to(c, 0, height);
            cairo_rel_line_to(c, width, 0);
            cairo_rel_line_to(c, 0, -height);
            cairo_close_path(c);
        }
        cairo_clip(c);
        cairo_translate(c, part.x, part.y);
        for (const DrawingItem& item : part.drawing) {
            if (const Text* text = std::get_if<Text>(&item.shape)) put_text(c, item, *text, figure.outlines);
            else draw(c, {item});
        }
        cairo_restore(c);
    }
    check(c);
    finish(surface);
    return bytes;
}

std::string png_bytes(const Image& image) {
    std::string bytes;
    const Target surface = raster_surface(image);
    if (cairo_surface_write_to_png_stream(surface.get(), append, &bytes) != CAIRO_STATUS_SUCCESS) throw std::runtime_error("Cairo failed to write a PNG file");
    return bytes;
}

PlacedText placed_text(const MathText& text, double size) {
    struct Collect {
        PlacedText& all;
        void run(cairo_t* c, PangoLayoutLine*, const TextRun& run, double grown) const {
            double x = 0, y = 0;
            cairo_get_current_point(c, &x, &y);
            all.runs.push_back({&run, x, y, grown * run.scale});
        }
        void bar(cairo_t*, const TextBox& b) const { all.bars.push_back(b); }
    };
    const Canvas canvas;
    PlacedText all;
    set(canvas.context.get(), text, size, 0, 0, Collect{all});
    return all;
}

std::string outline_path(const Text& text) {
    const Canvas canvas;
    cairo_t* c = canvas.context.get();
    set(c, text);
    std::unique_ptr<cairo_path_t, Release<cairo_path_destroy>> path(cairo_copy_path(c));
    std::string d;
    for (int i = 0; i < path->num_data; i += path->data[i].header.length) {
        const cairo_path_data_t* step = &path->data[i];
        d += "MLCZ"[step->header.type];
        for (int k = 1; k < step->header.length; ++k) {
            char pair[64];
            std::snprintf(pair, sizeof pair, "%s%.2f %.2f", k > 1 ? " " : "", step[k].point.x, step[k].point.y);
            d += pair;
        }
    }
    return d;
}

TextBox text_box(const MathText& text, double size) {
    const Canvas canvas;
    return set(canvas.context.get(), text, size, 0, 0);
}

}  // namespace isoparm
