#include "scene/scene.h"

namespace isoparm {

const Surface* Scene::find_surface(const std::string& name) const {
    for (const Surface& s : surfaces)
        if (s.name == name) return &s;
    return nullptr;
}
const Curve* Scene::find_curve(const std::string& name) const {
    for (const auto& c : curves)
        if (c.first == name) return &c.second;
    return nullptr;
}

namespace {

class Union {
public:
    void add(const Bounds& b) { box_ = box_ ? united(*box_, b) : b; }
    void add(const Point& p) { add(Bounds{p, p}); }
    void add(const Surface* s) {
        if (s) add(bounding_box(s->patches));
    }
    void add(const Curve* c) {
        if (c) add(bounding_box(*c));
    }
    bool empty() const { return !box_; }
    Bounds box() const { return box_.value_or(Bounds{{0, 0, 0}, {0, 0, 0}}); }

private:
    std::optional<Bounds> box_;
};

void add_object(Union& all, const Scene& scene, const SceneObject& o) {
    switch (o.kind) {
        case SceneObject::Kind::surface: return all.add(scene.find_surface(o.name));
        case SceneObject::Kind::curve: return all.add(scene.find_curve(o.name));
        case SceneObject::Kind::point: return all.add(o.point);
        case SceneObject::Kind::net:
            for (const Point& p : o.net.points) all.add(p);
            return;
        case SceneObject::Kind::axes:
            for (const Point& p : ends_of(o.axes)) all.add(p);
            return;
        case SceneObject::Kind::arrow:
            all.add(o.arrow.tail);
            all.add(o.arrow.tip);
    }
}

}  // namespace

void set_points(std::vector<SceneObject>& objects, double pixels) {
    const auto set = [&](Extent& e) {
        if (e.points) e = pixels * e.value;
    };
    const auto set_line = [&](LineStyle& line) {
        set(line.width);
        for (Extent& e : line.dash) set(e);
    };
    for (SceneObject& o : objects) {
        set(o.isolines.width);
        set_line(o.line);
        set_line(o.outline.line);
        set(o.comb.width);
        set(o.jumps.width);
        set(o.twists.width);
        if (o.label.size) set(*o.label.size);
        for (Label& l : o.net_labels)
            if (l.size) set(*l.size);
    }
}

std::vector<Point> ends_of(const Axes& axes) {
    std::vector<Point> ends;
    for (int k = 0; k < 3; ++k) {
        if (!axes.axis[k]) continue;
        ends.insert(ends.end(), 2, axes.origin);
        ends[ends.size() - 2][k] = axes.axis[k]->low;
        ends.back()[k] = axes.axis[k]->high;
    }
    return ends;
}

Bounds bounding_box(const Scene& scene) {
    Union all;
    for (const SceneObject& o : scene.objects) add_object(all, scene, o);
    if (!all.empty()) return all.box();
    for (const Surface& s : scene.surfaces) all.add(&s);
    for (const auto& c : scene.curves) all.add(&c.second);
    return all.box();
}

}  // namespace isoparm
