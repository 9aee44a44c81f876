// paper.h -- a picture for print: the traced raster with what lies over it as lines and text, on a page of a given size.
//
// .pdf   one page; fonts are embedded, text can be selected, or letters are outlines.
// .svg   the raster as a data: PNG; letters are <text> in the fonts of the reader's machine, or outlines. Every letter stands where it was
//        measured, so that other fonts do no harm to the layout.
// .tex   TikZ to \input where the package tikz is loaded; labels are nodes in the document's own font, the raster lies beside it.
//
// Viewers blend sRGB bytes where isoparm blends light: opacities are changed so that the outcome is the same on what the raster has there.
// The same figure gives the same bytes.
#pragma once
#include <string>

#include "drawing/drawing.h"
#include "image/image.h"

namespace isoparm {

struct PaperFigure {
    Image raster;
    std::vector<DrawnPart> parts;
    double pixels_per_point = 300.0 / 72;  // of the printed page; 72 points are an inch
    std::string title;
    bool outlines = false;                 // letters as outlines
};

/// Is this the path of a figure for print: .pdf, .svg or .tex?
bool is_paper(const std::string& path);
/// The files that writing a picture there makes: a .tex has its raster beside it.
std::vector<std::string> paper_files(const std::string& path);
/// Writes each to a temporary name and renames it. Throws Error(io).
void write_paper(const std::string& path, PaperFigure figure, const Metadata& metadata);

/// Of the rim of a text whose opacity is for sRGB: about what halo_opacity() makes of light.
inline double printed_halo(double of_text) { return 0.85 * of_text * of_text; }

/// As the format has it, without zeros at the end.
std::string decimal(double x, const char* format = "%.3f");

// What write_paper() writes, once the opacities are right.
std::string svg_text(const PaperFigure& figure);
/// `raster`: the name of its file, as \includegraphics finds it.
std::string tikz_text(const PaperFigure& figure, const std::string& raster);

}  // namespace isoparm
