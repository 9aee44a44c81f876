#include "verify.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "error.h"
#include "meshes/finer_mesh.h"
#include "meshes/mesh_distance.h"
#include "scalar/interval.h"

namespace isoparm {
namespace {

constexpr double kFirst = 1e-3;       // error of the first finer mesh, of the size of the surface
constexpr double kExact = 1e-11;      // distances below this, of the size of all coordinates, are not told apart
constexpr double kStep = 16;          // from one finer mesh to the next, while the distance is not known
constexpr double kBetween = 0.15;     // error of the one before the last, of the distance
constexpr double kLeastGap = 1e-3;    // when the limit lies in the interval

/// The share of the gap that the error of the finer mesh may take, and that bounds of triangles may.
constexpr double kErrorShare = 0.4, kBoundShare = 0.1;

class Verifier {
public:
    Verifier(const TriangleMesh& mesh, const Composite& surface, const VerifyOptions& options)
        : mesh_(mesh), tree_(mesh), surface_(surface), options_(options), gap_(options.gap), size_(bounding_box(surface).diagonal()) {
        if (!(size_ < 1e50) || !(tree_.size() <= 1e50)) throw_input("found coordinates of size " + to_text(std::max(size_, tree_.size())) + ", expected at most 1e50; scale the data");
        if (!(size_ > 0)) throw_input("found a surface of size 0, expected one that a mesh can be compared with");
        s_.upper = m_.upper = std::numeric_limits<double>::infinity();
        s_.lower = m_.lower = -std::numeric_limits<double>::infinity();
    }

    Verification run() {
        make_first();
        for (bool last = false;;) {
            const TriangleTree& finer = finer_->tree();
            exact_ = kExact * std::max(tree_.size(), finer.size());
            if (!s_.narrowed) sample_surface();
            if (!m_.narrowed) sample_mesh(finer);
            last = last || next_error() == 0;
            if (!s_.narrowed && (last || fine_enough(s_seen_))) cover_surface();
            if (!m_.narrowed && (last || fine_enough(m_seen_))) cover_mesh(finer);
            if (s_.lower > s_.upper || m_.lower > m_.upper) throw std::logic_error("a proved lower bound is above a proved upper one: please report this scene and mesh");
            decide();
            if ((s_.narrowed && m_.narrowed) || last) return result();
            const double next = spent_ ? 0 : next_error();
            last = next == 0 || !make_finer(next);  // then once more with the same mesh, for what was put off
        }
    }

private:
    // ---- the finer mesh
    void make_first() {
        for (double error = kFirst * size_;; error *= 4) try {
                make_finer(error);
                return;
            } catch (const Error& e) {
                if (e.kind() != ErrorKind::budget || error > size_) throw;
            }
    }
    /// False where it cannot be made; then the one before stays.
    bool make_finer(double error) {
        try {
            auto made = std::make_unique<FinerMesh>(surface_, error, 2 * options_.max_triangles, [&](double f) { report(0, f); });
            coarser_ = std::move(finer_);
            finer_ = std::move(made);
            return true;
        } catch (const Error& e) {
            if (e.kind() != ErrorKind::budget || !finer_) throw;
            stopped_ = e.what();
            return false;
        }
    }
    /// 0: no finer one is of use, or within the budget.
    double next_error() const {
        double distance = 0;  // known to be about that
        if (!s_.narrowed) distance = s_seen_;
        if (!m_.narrowed && m_seen_ > 4 * finer_->error()) distance = std::max(distance, m_seen_);
        const double now = finer_->error(), least = now * double(finer_->mesh().triangles.size()) / (2 * double(options_.max_triangles));
        double next = now / kStep;
        if (distance > 0) next = std::min(now / 1.5, (now > 4 * kBetween * distance ? kBetween : kErrorShare * gap_) * distance);
        next = std::max(next, least);
        return now > exact_ && next <= now / 1.2 ? next : 0;
    }
    std::string budget_text() const {
        return "with " + std::to_string(finer_->mesh().triangles.size()) + " triangles in place of the surface; to narrow it further takes more than the budget of " +
               std::to_string(options_.max_triangles) + " (--max-triangles)";
    }
    void report(int part, double fraction) const {
        if (options_.progress) options_.progress((part + fraction) / 3);
    }

    // ---- the two ways
    void sample_surface() {
        const Farthest far = farthest_point(finer_->places(), [&](std::size_t i) { return finer_->near(i); }, tree_);
        s_seen_ = far.distance;
        const FinerMesh::Place place = finer_->place(far.index);
        const Vec3<Interval> box = surface_[place.member].patch.enclose_point(place.uv.x, place.uv.y);
        const Point p{mid(box.x), mid(box.y), mid(box.z)};
        const double lower = rounding::down(tree_.distance_down(p) - rounding::length_up(rad(box.x), rad(box.y), rad(box.z)));
        if (lower > s_.lower) s_.lower = lower, s_.at = p, s_.member = place.member, s_.uv = place.uv;
    }
    void cover_surface() {
        const TriangleMesh& from = finer_->mesh();
        const Reach reach = reach_of(from.triangles.size(), [&](std::size_t t) { return Piece(from.corners(t), t); }, tree_, reach_options(s_seen_ * (1 + kBoundShare * gap_), 1));
        if (reach.seen > s_seen_) {  // on the finer mesh: the surface has a point within its error of there
            s_seen_ = reach.seen;
            const double lower = rounding::down(rounding::down(tree_.distance_down(reach.at) - finer_->error()) - reach.at_slack);
            if (lower > s_.lower) {
                const FinerMesh::Place place = finer_->place_in(reach.triangle, reach.at);
                s_.lower = lower, s_.member = place.member, s_.uv = place.uv, s_.at = surface_[place.member].patch.point(place.uv.x, place.uv.y);
            }
        }
        s_.upper = std::min(s_.upper, rounding::up(reach.upper + finer_->error()));
        spent_ = spent_ || reach.spent;
    }

    /// Vertices and middles of triangles.
    void sample_mesh(const TriangleTree& finer) {
        const std::size_t corners = 3 * mesh_.triangles.size();
        const auto sample = [&](std::size_t i) {
            if (i < corners) return mesh_.points[mesh_.triangles[i / 3][i % 3]];
            const auto [a, b, c] = mesh_.corners(i - corners);
            return (a + b + c) / 3.0;
        };
        const Farthest far = farthest_point(corners + mesh_.triangles.size(), sample, finer);
        const bool corner = far.index < corners;
        m_seen_ = far.distance;
        raise_lower(finer, sample(far.index), corner ? 0 : 16 * 0x1p-53 * tree_.size(), corner ? far.index / 3 : far.index - corners);
    }
    /// What is well below the largest distance is settled by the mesh before this one, which has fewer triangles.
    void cover_mesh(const TriangleTree& finer) {
        const double good = m_seen_ * (1 + kBoundShare * gap_), coarse_good = good - (coarser_ ? coarser_->error() - finer_->error() : 0);
        std::vector<Piece> left;
        double upper = 0;
        const bool two = coarser_ && coarse_good > 0.5 * good && coarser_->mesh().triangles.size() < finer_->mesh().triangles.size() / 2;
        if (two) {
            ReachOptions how = reach_options(coarse_good, 1);
            how.left = &left;
            const Reach reach = reach_of(mesh_.triangles.size(), [&](std::size_t t) { return Piece(mesh_.corners(t), t); }, coarser_->tree(), how);
            upper = rounding::up(reach.upper + coarser_->error());
            spent_ = spent_ || reach.spent;
            for (Piece& p : left) p.hint = p.host = TriangleTree::none, p.upper = std::numeric_limits<double>::infinity();
        }
        const auto piece = [&](std::size_t i) { return two ? left[i] : Piece(mesh_.corners(i), i); };
        const Reach reach = reach_of(two ? left.size() : mesh_.triangles.size(), piece, finer, reach_options(good, 2));
        if (reach.seen > m_seen_) m_seen_ = reach.seen, raise_lower(finer, reach.at, reach.at_slack, reach.triangle);
        m_.upper = std::min(m_.upper, std::max(upper, rounding::up(reach.upper + finer_->error())));
        spent_ = spent_ || reach.spent;
        compare_normals(finer);
    }

    /// `slack`: at least the distance of p from the triangle of the mesh that it belongs to.
    void raise_lower(const TriangleTree& finer, const Point& p, double slack, std::size_t triangle) {
        const double lower = rounding::down(rounding::down(finer.distance_down(p) - finer_->error()) - slack);
        if (lower > m_.lower) m_.lower = lower, m_.at = p, m_.triangle = triangle;
    }

    bool fine_enough(double seen) const { return finer_->error() <= 1.3 * kErrorShare * gap_ * seen; }

    ReachOptions reach_options(double good, int part) const {
        ReachOptions how;
        how.good = std::max(good, exact_);
        how.gap = kBoundShare * gap_;
        how.coordinate = std::max(tree_.size(), finer_->tree().size());
        how.progress = [this, part](double f) { report(part, f); };
        return how;
    }

    void decide() {
        for (DirectedDistance* d : {&s_, &m_}) d->narrowed = std::isfinite(d->upper) && (d->upper - d->lower <= gap_ * d->upper || d->upper <= 4 * exact_);
        if (!options_.limit || !s_.narrowed || !m_.narrowed) return;
        const double lower = std::max(s_.lower, m_.lower), upper = std::max(s_.upper, m_.upper);
        if (upper <= *options_.limit || lower > *options_.limit || gap_ <= kLeastGap) return;
        gap_ = std::max(kLeastGap, gap_ / 3);
        for (DirectedDistance* d : {&s_, &m_}) d->narrowed = d->upper <= *options_.limit;
    }

    // ---- normals
    std::optional<Point> normal_at(const FinerMesh::Place& at) const {
        const Patch& patch = surface_[at.member].patch;
        const PointFrame f = patch.frame(at.uv.x, at.uv.y);
        const auto derivative = [&](int i, int j) { return Point{f.x.coefficient(i, j), f.y.coefficient(i, j), f.z.coefficient(i, j)}; };
        const Point u = derivative(1, 0), v = derivative(0, 1), n = cross(u, v);
        if (length(n) > 1e-6 * length(u) * length(v)) return normalized(n);
        return unit_normal(patch, patch.jet(at.uv.x, at.uv.y), at.uv.x, at.uv.y);
    }

    void compare_normals(const TriangleTree& finer) {
        const std::size_t count = mesh_.triangles.size();
        std::vector<double> angle(count, -1), away(count);
        std::vector<char> same(count, 0);
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 256), [&](const auto& range) {
            for (std::size_t t = range.begin(); t < range.end(); ++t) {
                const auto [a, b, c] = mesh_.corners(t);
                const Point n = cross(b - a, c - a), middle = (a + b + c) / 3.0;
                const auto near = finer.nearest(middle);
                away[t] = near.distance;
                const FinerMesh::Place place = finer_->place_in(near.triangle, near.point);
                const auto normal = normal_at(place);
                if (!(length(n) > 0) || !normal) continue;
                angle[t] = std::atan2(length(cross(n, *normal)), std::fabs(dot(n, *normal))) * 180 / std::numbers::pi;
                same[t] = (dot(n, *normal) > 0) != place.flipped;
            }
        });
        NormalDeviation d;
        std::size_t along = 0;
        for (std::size_t t = 0; t < count; ++t) {
            if (angle[t] < 0) continue;
            ++d.compared, along += same[t], d.mean += angle[t];
            if (angle[t] > d.most) d.most = angle[t], d.worst = t;
        }
        d.mean /= double(std::max<std::size_t>(1, d.compared));
        d.against = std::min(along, d.compared - along);
        normals_ = d;
        const auto tenth = away.begin() + static_cast<std::ptrdiff_t>(9 * (count - 1) / 10);
        std::nth_element(away.begin(), tenth, away.end());
        usual_ = *tenth;
    }

    Verification result() const {
        Verification r;
        r.surface_to_mesh = s_, r.mesh_to_surface = m_;
        r.normals = normals_, r.usual = usual_;
        r.border = finer_->open_edges(), r.finer_triangles = finer_->mesh().triangles.size(), r.finer_error = finer_->error();
        for (DirectedDistance* d : {&r.surface_to_mesh, &r.mesh_to_surface}) d->lower = std::max(0.0, d->lower);
        if (!s_.narrowed || !m_.narrowed) r.stopped = spent_ ? "a triangle has too many of the others beside it" : !stopped_.empty() ? stopped_ : budget_text();
        return r;
    }

    const TriangleMesh& mesh_;
    const TriangleTree tree_;
    const Composite& surface_;
    const VerifyOptions& options_;
    double gap_;
    const double size_;
    double exact_ = 0;
    std::unique_ptr<FinerMesh> finer_, coarser_;  // the last one, and the one before
    DirectedDistance s_, m_;            // surface to mesh, mesh to surface
    double usual_ = 0;
    double s_seen_ = 0, m_seen_ = 0;    // the largest distances at sample points
    NormalDeviation normals_;
    std::string stopped_;
    bool spent_ = false;
};

}  // namespace

Verification verify(const TriangleMesh& mesh, const Composite& surface, const VerifyOptions& options) { return Verifier(mesh, surface, options).run(); }

}  // namespace isoparm
