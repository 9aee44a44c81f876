// scene.h -- a scene as a value: what a scene file says, resolved, with nothing left to look up.
#pragma once
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "composite.h"
#include "curve.h"
#include "drawing/math_text.h"
#include "light/light.h"

namespace isoparm {

struct DataReport;  // promises.h

using Color = Vec3<double>;  // linear RGB inside the program; scene files give sRGB values in [0,1]

/// A named surface: one patch, or the members of a composite or of an imported file.
struct Surface {
    std::string name, type;
    Composite patches;
    std::string detail;  // for people: "degree 3 x 3, rational"
    std::function<DataReport()> examine;  // its data and what it promises of them; empty where it promises nothing
};

/// A length on the picture: pixels of the scene's picture, or points of the printed one, which a scene file writes as "0.5pt".
struct Extent {
    double value = 0;
    bool points = false;
    Extent(double v = 0, bool p = false) : value(v), points(p) {}
    operator double() const { return value; }
};

/// Lines u = const and v = const drawn on a surface: how many of each (ends included), in equal steps of the domain.
struct Isolines {
    int u = 0, v = 0;
    Extent width = 1.2;
    Color color{0, 0, 0};
    double opacity = 0.55;
};

/// Points to join by straight rods: rows of a control net, a polygon of poles.
struct ControlNet {
    std::vector<Point> points;
    std::vector<std::array<int, 2>> rods;
    std::vector<std::string> indices;  // of each point, as its label has them: "01", "10,2"
};

/// What becomes of the part of a line or label that lies behind surfaces: shown fainter, left out, shown all the same,
/// or dashed (a label: fainter).
enum class Hidden { ghost, hide, show, dash };

struct Label {
    MathText text;  // empty: none
    std::optional<double> at;      // parameter of the curve
    std::optional<Vec2> at_uv;     // of the surface
    std::optional<Extent> size;    // of the letters; default a fraction of the picture's height
    std::optional<Color> color;
    Hidden hidden = Hidden::ghost;
    std::optional<bool> leader;    // a line to what it names: always, with the label apart from it; never; default: when it had to move far
    std::optional<int> side;       // 0 right, 1 above right, 2 above ... 7 below right, 8 on the spot
};

/// A curve, boundary or net drawn flat, or the diameter of a flat dot.
struct LineStyle {
    Extent width = 0;  // 0: a tube instead
    std::vector<Extent> dash;
    Hidden hidden = Hidden::hide;
};

/// The lines where a surface turns away from the eye, and its borders.
struct Outline {
    LineStyle line;  // width 0: none
    std::optional<Color> color;
    double opacity = 1;
};

/// A surface coloured by its curvature, or striped as a polished one is by what it mirrors.
struct ColorBy {
    enum class What { none, gaussian, mean, k1, k2, reflection, isophotes } what = What::none;
    std::optional<std::array<double, 2>> range;  // of the colours, low < high; default: of nearly all samples
    double stripes = 24;                         // pairs of a light and a dark one in 360 degrees
    std::optional<Point> direction;              // reflection: of the lamps; isophotes: toward the light
    bool legend = false;
    bool curvature() const { return what != What::none && what < What::reflection; }
    bool striped() const { return what >= What::reflection; }
};

/// Lines along the edges where the patches of a surface join, and between the cells of a patch, coloured by how much jumps across them.
struct JumpHeat {
    enum class Of { none, g1, g2 } of = Of::none;  // the angle of the normals in degrees; the normal curvature across the edge
    std::optional<double> top;                     // of the colours, which begin at 0; default: the largest, made round
    Extent width = 4;                              // pixels
    bool legend = false;
};

/// Teeth on a curve, away from its centres of curvature, each as long as `scale` times the curvature.
struct Comb {
    int teeth = 0;               // 0: no comb
    std::optional<double> scale; // scene units squared; default: the longest is an eighth of the scene's size
    Extent width = 1;            // pixels
    std::optional<Color> color;
};

/// Both mixed derivatives of a surface's data as arrows, at each corner where they disagree.
struct TwistArrows {
    bool on = false;
    std::optional<double> scale;  // length of the arrow of a twist of length 1, scene units; default: the longest is a sixth of the scene's size
    Extent width = 3;             // pixels
    bool legend = false;
};

/// Coordinate axes through `origin`, each over its range; ticks in ascending order.
struct Axes {
    struct Axis {
        double low = 0, high = 1;
        std::optional<std::vector<double>> ticks;  // default: round numbers
        MathText name;
        std::vector<MathText> tick_texts{};  // of the ticks, instead of numbers where they are not empty; none: all numbers
    };
    std::array<std::optional<Axis>, 3> axis;
    Point origin{0, 0, 0};
};

/// A vector: a tangent, a normal, a twist.
struct Arrow {
    Point tail, tip;
};

struct SceneObject {
    enum class Kind { surface, curve, net, point, axes, arrow } kind = Kind::surface;
    std::string name;              // of the surface or curve
    Label label;
    std::optional<Color> color;    // default by kind
    std::optional<Color> back;     // Kind::surface: of its other side; default a grey that goes with `color`
    double opacity = 1;
    Material material;             // of traced light
    std::optional<Extent> radius;  // of tubes, rods and balls, scene units (not pixels) or points; default a fraction of the scene's size
    Isolines isolines;
    ColorBy color_by;              // Kind::surface
    JumpHeat jumps;                // Kind::surface
    TwistArrows twists;            // Kind::surface
    Comb comb;                     // Kind::curve
    bool boundary = false;         // draw the patches' boundary curves as tubes
    Outline outline;               // Kind::surface
    LineStyle line;
    Point point;                   // Kind::point
    ControlNet net;                // Kind::net
    std::vector<Label> net_labels; // Kind::net: one a point, or none
    Axes axes;                     // Kind::axes
    Arrow arrow;                   // Kind::arrow
};

struct CameraSettings {
    std::optional<Point> eye, target, up;
    double fov = 35;                     // vertical, degrees
    std::optional<double> orthographic;  // height of the view in scene units; 0: fitted
    bool fit = false;                    // move back (or zoom) until everything is inside, keeping the direction
};

struct ImageSettings {
    int width = 1024, height = 768;
    int samples = 0;                  // 0: as many as is usual
    double noise = 0;                 // the target; 0: none
    std::optional<Color> background;  // none: transparent
};

struct Tolerance {
    enum class Unit { absolute, relative, pixels } unit = Unit::relative;
    double value = 1e-4;  // relative: of the bounding-box diagonal
    /// In scene units, where these are a diagonal and a pixel.
    double absolute(double diagonal, double pixel) const { return unit == Unit::absolute ? value : value * (unit == Unit::relative ? diagonal : pixel); }
};

/// An enlarged part of a picture or panel, or another view of its objects, in a frame that lies over it. Lengths are parts of its
/// width and height, from its top left corner.
struct Inset {
    int side = 1;                        // where the frame lies: as Label::side
    std::optional<Vec2> at;              // instead: its top left corner
    double width = 0.35;
    std::optional<double> height;        // default: as high as wide, in proportion to the picture or the region
    std::optional<std::array<double, 4>> region;  // what is enlarged: x0, y0, x1, y1
    std::optional<Point> around;         // or what is around this point, `zoom` times as large
    double zoom = 3;
    std::optional<CameraSettings> camera;  // or this view
    bool lines = true;                   // from the corners of what is enlarged to those of the frame
    Extent line = 1;
    std::optional<Color> color;
};

/// A part of the picture, with a title under it, that shows some of the scene's objects.
struct Panel {
    std::size_t first = 0, last = 0;       // objects first <= i < last
    MathText title;                        // may be empty
    std::optional<CameraSettings> camera;  // default: the scene's, which fits the objects of all panels
    MathText mark;                         // "(a)"; may be empty
    std::vector<Inset> insets;
};

struct Scene {
    std::string path, title, source;
    std::string place;  // "path:line:column: at $.objects", or of the whole when nothing is named there
    std::map<std::string, double> parameters;
    std::map<std::string, std::array<double, 2>> ranges;  // of the parameters; infinite where the file gives none
    std::vector<std::pair<std::string, Curve>> curves;  // in the order of the file
    std::vector<Surface> surfaces;
    std::vector<SceneObject> objects;  // of all panels, one after the other, when there are panels
    std::vector<Panel> panels;
    int panel_rows = 1, panel_columns = 1;
    bool marks_inside = false;         // the panels' marks: in their top left corners instead of before their titles
    std::vector<Inset> insets;         // of a scene without panels
    CameraSettings camera;
    ImageSettings image;
    std::optional<LightingSettings> lighting;  // none: the figures' own
    std::optional<Ground> ground;
    Tolerance tolerance;
    std::vector<std::string> notes;  // what was done to definitions, each with its place
    std::vector<std::string> included;  // paths of the files that it names and that were read

    /// nullptr when there is none of that name.
    const Surface* find_surface(const std::string& name) const;
    const Curve* find_curve(const std::string& name) const;
};

/// Lengths in points become pixels of the scene's picture: `pixels` a point.
void set_points(std::vector<SceneObject>& objects, double pixels);

/// Where the axes begin and end, two points each.
std::vector<Point> ends_of(const Axes& axes);

/// Box around everything that is drawn (all surfaces and curves when nothing is).
Bounds bounding_box(const Scene& scene);

/// Reads and checks a scene file. Throws Error(input) with "path:line:column: at $.json.path: found ..., expected ...".
/// `overrides` are --set values of parameters.
Scene load_scene(const std::string& path, const std::map<std::string, double>& overrides = {});

/// A camera that a file holds by itself, as a scene's "camera". Throws Error(input) likewise.
CameraSettings load_camera(const std::string& path);

}  // namespace isoparm
