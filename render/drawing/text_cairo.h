// text_cairo.h -- how much of each pixel a line, an area or a text covers, and drawings as SVG or PDF. text_cairo.cpp is the only file that
// includes Cairo and Pango; linking them costs 8 ms at the start of the program, loading them when needed would save
// less than it complicates.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "drawing/drawing.h"
#include "drawing/paper.h"

namespace isoparm {

/// A box of pixels and the part of each that is covered, in 255ths.
struct Coverage {
    int x0 = 0, y0 = 0, width = 0, height = 0;
    std::vector<std::uint8_t> part;  // width * height, rows from the top
};
/// Within a picture of width x height pixels. Throws Error(io) when no font has the letters.
Coverage coverage(const Polyline& line, int width, int height);
Coverage coverage(const Filled& area, int width, int height);
/// Of the letters, made fatter by `rim` pixels on every side.
Coverage coverage(const Text& text, double rim, int width, int height);

/// About a text whose base line begins at (0,0): what it covers (y down), and where the next letter would stand.
struct TextBox {
    double left = 0, top = 0, right = 0, bottom = 0, advance = 0;
};
TextBox text_box(const MathText& text, double size);

/// The drawing on white, width x height of its pixels, which are points in the PDF. Letters become outlines, so that it looks alike
/// everywhere. No date in it: the same drawing gives the same bytes. Throws Error(io) when no font has the letters.
enum class VectorFormat { svg, pdf };
std::string vector_file(const Drawing& drawing, double width, double height, VectorFormat format, const std::string& title);

/// A run of a text where it stands: where its base line begins when the text's does at (0,0).
struct PlacedRun {
    const TextRun* run;
    double x, y, scale;
};
struct PlacedText {
    std::vector<PlacedRun> runs;
    std::vector<TextBox> bars;  // over what is under a root
};
PlacedText placed_text(const MathText& text, double size);
/// The outlines of a text's letters, where it stands, as the d of an SVG path; numbers with two decimals. Filled by the nonzero rule.
std::string outline_path(const Text& text);

/// The figure as one page of PDF: the raster as it is, lines and areas as paths, letters as text with their fonts embedded, or as outlines.
std::string pdf_page(const PaperFigure& figure);
/// The picture as PNG: sRGB, 8 bits, with alpha unless it is opaque.
std::string png_bytes(const Image& image);

}  // namespace isoparm
