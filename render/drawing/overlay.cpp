#include "drawing/overlay.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>

#include "drawing/arrows.h"
#include "drawing/axes.h"
#include "drawing/comb.h"
#include "drawing/drawn.h"
#include "drawing/flat_lines.h"
#include "drawing/jump_heat.h"
#include "drawing/label_anchors.h"
#include "drawing/labels.h"
#include "drawing/legend.h"
#include "drawing/outlines.h"
#include "drawing/surface_lines.h"
#include "drawing/twist_arrows.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

constexpr int kOnTheSpot = 8;

using Kind = SceneObject::Kind;

class Overlay {
public:
    Overlay(const Scene& scene, const TracedScene& traced, const Camera& camera, double pixel, double letter, bool isolines, const OverlayPlace& place)
        : scene_(scene),
          camera_(camera),
          sight_(traced, camera),
          pixel_(pixel),
          size_(bounding_box(scene).diagonal()),
          letter_(letter),
          isolines_(isolines),
          place_(place),
          scales_(scales_of(traced.things)) {
        if (!(size_ > 0)) size_ = 1;
    }

    Drawing run(const std::vector<SceneObject>& objects) {
        anchors_.emplace(scene_, camera_, sight_, pixel_, letter_, objects);
        const auto sight_on = [&](const SceneObject& o) { return o.kind == Kind::surface ? sight_.on(std::size_t(&o - objects.data())) : sight_; };
        for (const SceneObject& o : objects)
            if (o.kind == Kind::surface) add_surface_lines(o, sight_on(o));
        for (const SceneObject& o : objects) add(o, sight_on(o));
        for (const auto& [x, y, width, height] : place_.covered) avoid_box(x, y, width, height);
        for (const SceneObject& o : objects) add_labels(o, sight_on(o));
        place_labels(requests_, obstacles_, camera_.width, camera_.height, drawing_, marks_);
        if (!place_.inset) {
            const LegendRoom room = legend_room(objects, letter_, 2 * camera_.width);
            const Drawing bars = legends(scales_, camera_.width + room.width, camera_.height, room.letter);
            drawing_.insert(drawing_.end(), bars.begin(), bars.end());
        }
        return std::move(drawing_);
    }

private:
    // ---- lines ----------------------------------------------------------------------------------------------------
    void add(const SceneObject& o, const Sight& sight) {
        const double radius = radius_of(o, size_);
        switch (o.kind) {
            case Kind::surface:
                add_jumps(o, sight);
                add_twists(o);
                if (!o.boundary) return;
                for (const DrawnCurve& edge : drawn_edges(surface_of(scene_, o).patches, size_))
                    add(o, points_of(edge), curve_color(), 1, radius, sight);
                return;
            case Kind::curve:
                add_comb(o);
                return add(o, points_of(drawn(curve_of(scene_, o))), o.color.value_or(curve_color()), o.opacity,
                           radius, sight);
            case Kind::net:
                for (const auto& [i, j] : o.net.rods)
                    add(o, points_between(o.net.points[i], o.net.points[j]), o.color.value_or(net_color()), o.opacity,
                        radius, sight);
                for (const Point& p : o.net.points) avoid({p}, kNetBall * radius);
                return;
            case Kind::point:
                avoid({o.point}, anchors_->radius_of_point(o));
                if (o.line.width > 0) add_dot(o);
                return;
            case Kind::axes:
                add_axes(o, o.color.value_or(ink_color()), sight_, pixel_,
                         o.label.size ? *o.label.size * pixel_ : letter_, obstacles_, marks_, drawing_);
                return;
            case Kind::arrow:
                add_arrow(o.arrow, {o.color.value_or(ink_color()), o.opacity, o.line.width * pixel_, scaled(o.line.dash), o.line.hidden}, sight_, drawing_);
                avoid(points_between(o.arrow.tail, o.arrow.tip), 0);
        }
    }
    void add_surface_lines(const SceneObject& o, const Sight& sight) {
        const Composite& patches = surface_of(scene_, o).patches;
        if (isolines_ && o.opacity > 0) add_isolines(patches, o.isolines, pixel_, size_, sight, drawing_);
        if (!(o.outline.line.width > 0)) return;
        const std::size_t first = drawing_.size();
        for (const auto& points : outline_of(patches, camera_, size_, !o.boundary)) {
            avoid(points, 0);
            const LineStyle& line = o.outline.line;
            add_line(points, {o.outline.color.value_or(curve_color()), o.outline.opacity, line.width * pixel_, scaled(line.dash), line.hidden}, sight, 0, drawing_);
        }
        join_lines(drawing_, first);
    }
    /// A flat line, or what a tube of that radius covers already.
    void add(const SceneObject& o, const std::vector<Point>& points, const Color& color, double opacity,
             double radius, const Sight& sight) {
        avoid(points, o.line.width > 0 ? 0 : radius);
        add_line(points, {color, opacity, o.line.width * pixel_, scaled(o.line.dash), o.line.hidden}, sight, 0,
                 drawing_);
    }
    void add_jumps(const SceneObject& o, const Sight& sight) {
        if (o.jumps.of == JumpHeat::Of::none) return;
        const auto edges = hot_edges(surface_of(scene_, o).patches, o.jumps.of, size_);
        const ColorScale scale = scale_of(o.jumps, edges, size_);
        for (const HotEdge& e : edges)
            for (std::size_t k = 0; k + 1 < e.points.size(); ++k) {
                const double jump = std::max(e.jumps[k], e.jumps[k + 1]);
                if (jump >= 0) add_line(points_between(e.points[k], e.points[k + 1]), {scale.color(jump), 1, o.jumps.width * pixel_, {}, Hidden::hide}, sight, 0, drawing_);
            }
        if (o.jumps.legend) scales_.push_back(scale);
    }
    void add_twists(const SceneObject& o) {
        if (!o.twists.on) return;
        const Surface& surface = surface_of(scene_, o);
        for (const TwistArrow& t : twist_arrows(surface, o.twists, size_)) {
            for (const auto& [tip, which] : {std::pair(t.tip_f, 0), {t.tip_g, 1}}) {
                add_arrow({t.foot, tip}, {twist_color(which), 1, o.twists.width * pixel_, {}, Hidden::ghost}, sight_, drawing_);
                avoid(points_between(t.foot, tip), 0);
            }
            Label& label = labels_.emplace_back();
            label.text = parse_math_text(t.gap, true);
            label.hidden = Hidden::show;
            request(label, {anchors_->at(t.tip_f, 0), anchors_->at(t.tip_g, 0), anchors_->at(t.foot, 0)});
        }
        if (!o.twists.legend) return;
        add_twist_legend(surface, o.twists, size_, letter_, drawing_);
        for (double x = 1; x < 12; x += 0.8)
            for (double y = 0.8; y < 4; y += 0.8) obstacles_.push_back({{x * letter_, y * letter_}, 0.4 * letter_});
    }
    void add_comb(const SceneObject& o) {
        const LineLook look{o.comb.color.value_or(point_color()), o.opacity, o.comb.width * pixel_, {}, Hidden::show};
        std::vector<Point> tips;
        for (const auto& [foot, tip] : comb_teeth(curve_of(scene_, o), o.comb, size_)) {
            add_line(points_between(foot, tip), look, sight_, 0, drawing_);
            if (!tips.empty()) add_line(points_between(tips.back(), tip), look, sight_, 0, drawing_);
            tips.push_back(tip);
        }
        avoid(tips, 0);
    }
    void add_dot(const SceneObject& o) {
        constexpr int kCorners = 48;
        if (!(camera_.depth(o.point) > 0)) return;
        const Vec2 at = camera_.project(o.point);
        const double radius = 0.5 * o.line.width * pixel_;
        Filled disc;
        for (int i = 0; i < kCorners; ++i) {
            const double turn = 2 * std::numbers::pi * i / kCorners;
            disc.outline.push_back({at.x + radius * std::cos(turn), at.y + radius * std::sin(turn)});
        }
        const double opacity = o.opacity * opacity_of(o.line.hidden, sight_.of(o.point));
        if (opacity > 0.02) drawing_.push_back({std::move(disc), o.color.value_or(point_color()), opacity});
    }
    std::vector<double> scaled(const std::vector<Extent>& dash) const {
        std::vector<double> all;
        for (const Extent& d : dash) all.push_back(d * pixel_);
        return all;
    }
    std::vector<Point> points_of(const DrawnCurve& curve) const {
        return fine_points(cubic_pieces(curve, 1e-5 * size_), camera_);
    }
    std::vector<Point> points_between(const Point& a, const Point& d) const {
        return fine_points({straight(a, d)}, camera_);
    }
    double in_pixels(double length, const Point& p) const { return length / camera_.pixel_size(camera_.depth(p)); }
    void avoid(const std::vector<Point>& points, double radius) {
        const Obstacle* last = nullptr;
        for (const Point& p : points) {
            if (!(camera_.depth(p) > 0)) continue;
            const Vec2 at = camera_.project(p);
            if (last && points.size() > 1 && std::hypot(at.x - last->at.x, at.y - last->at.y) < 0.2 * letter_) continue;
            obstacles_.push_back({at, in_pixels(radius, p)});
            last = &obstacles_.back();
        }
    }

    void avoid_box(double x, double y, double width, double height) {
        const double step = 0.4 * letter_;
        for (double left = x; left <= x + width; left += step)
            for (double top = y; top <= y + height; top += step) obstacles_.push_back({{left, top}, step});
    }

    // ---- labels ---------------------------------------------------------------------------------------------------
    void add_labels(const SceneObject& o, const Sight& sight) {
        for (std::size_t i = 0; i < o.net_labels.size(); ++i)
            request(o.net_labels[i], {anchors_->at(o.net.points[i], kNetBall * radius_of(o, size_))});
        if (!o.label.text.empty()) request(o.label, anchors_->of(o, sight), o.kind == Kind::surface ? kOnTheSpot : -1);
    }
    void request(const Label& label, const std::vector<Anchor>& anchors, int otherwise = -1) {
        LabelRequest r{&label,
                       label.side.value_or(otherwise),
                       {},
                       label.size ? *label.size * pixel_ : letter_,
                       label.color.value_or(ink_color())};
        for (const Anchor& a : anchors)
            if (std::isfinite(a.at.x + a.at.y) && !(a.seen == 0 && label.hidden == Hidden::hide) && (!place_.inset || inside(camera_, a.at)) && !covered(a.at))
                r.anchors.push_back(a);
        requests_.push_back(std::move(r));
    }
    bool covered(const Vec2& p) const {
        return std::any_of(place_.covered.begin(), place_.covered.end(), [&](const auto& b) { return p.x >= b[0] && p.x <= b[0] + b[2] && p.y >= b[1] && p.y <= b[1] + b[3]; });
    }

    const Scene& scene_;
    const Camera& camera_;
    Sight sight_;
    double pixel_, size_, letter_;
    bool isolines_;
    const OverlayPlace& place_;
    std::optional<LabelAnchors> anchors_;
    std::vector<Obstacle> obstacles_;
    std::vector<LabelRequest> requests_;
    std::vector<MarkRequest> marks_;
    std::deque<Label> labels_;  // that no object has
    std::vector<ColorScale> scales_;  // for legends
    Drawing drawing_;
};

}  // namespace

Drawing overlay(const Scene& scene, const std::vector<SceneObject>& objects, const TracedScene& traced,
                const Camera& camera, double pixel, double letter, bool isolines, const OverlayPlace& place) {
    const auto vectors = [&](const SceneObject& o) {
        return o.line.width > 0 || o.outline.line.width > 0 || (isolines && o.isolines.u + o.isolines.v > 0) || !o.label.text.empty() || !o.net_labels.empty() || o.kind == Kind::axes ||
               o.color_by.legend || o.jumps.of != JumpHeat::Of::none || o.comb.teeth > 0 || o.twists.on;
    };
    if (std::none_of(objects.begin(), objects.end(), vectors)) return {};
    return Overlay(scene, traced, camera, pixel, letter, isolines, place).run(objects);
}

}  // namespace isoparm
