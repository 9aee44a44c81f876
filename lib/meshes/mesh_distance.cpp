#include "meshes/mesh_distance.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>

namespace isoparm {
namespace {

constexpr double kUnit = 0x1p-53;
constexpr double kCut = 8 * kUnit;     // a cut's end is off by this times the largest coordinate at most
constexpr double kNear = 64 * kUnit;   // and the distance from the nearest point of a triangle by this
constexpr double kSafe = 1 + 1e-14;

Point centre_of(const Piece& p) {
    Point c{0, 0, 0};
    for (int k = 0; k < p.size; ++k) c += p.x[k];
    return c / double(p.size);
}

/// The two vertices that are farthest apart.
std::array<int, 2> diameter(const Piece& p) {
    std::array<int, 2> best{0, 0};
    double most = -1;
    for (int i = 0; i < p.size; ++i)
        for (int j = i + 1; j < p.size; ++j)
            if (const double d = distance(p.x[i], p.x[j]); d > most) most = d, best = {i, j};
    return best;
}

/// Cuts by the plane side(x) = normal.(x - origin) = 0: both parts, one of them empty where the piece lies on one side. Vertices no
/// farther than `tolerance` from the plane belong to both. False, and nothing else, where rounding has bent the piece so that the
/// plane would cut it more than twice.
bool cut(const Piece& piece, const Point& normal, const Point& origin, double tolerance, Piece& above, Piece& below) {
    std::array<double, Piece::most + 3> side;
    const double near = tolerance * length(normal);
    bool any_above = false, any_below = false;
    for (int k = 0; k < piece.size; ++k) {
        side[k] = dot(normal, piece.x[k] - origin);
        if (std::fabs(side[k]) <= near) side[k] = 0;
        any_above = any_above || side[k] > 0, any_below = any_below || side[k] < 0;
    }
    above = below = piece;
    if (!any_below) return below.size = 0, true;
    if (!any_above) return above.size = 0, true;
    above.size = below.size = 0;
    ++above.cuts, ++below.cuts;
    int ends = 0;
    for (int k = 0; k < piece.size; ++k) {
        const int next = k + 1 < piece.size ? k + 1 : 0;
        if (side[k] >= 0) above.x[above.size++] = piece.x[k];
        if (side[k] <= 0) below.x[below.size++] = piece.x[k], ends += side[k] == 0;
        if ((side[k] > 0 && side[next] < 0) || (side[k] < 0 && side[next] > 0)) {
            const double t = side[k] / (side[k] - side[next]);  // from 0 to 1
            const Point end = piece.x[k] + t * (piece.x[next] - piece.x[k]);
            above.x[above.size++] = end, below.x[below.size++] = end;
            ++ends;
        }
        if (above.size > Piece::most || below.size > Piece::most) return false;
    }
    return ends == 2;
}

/// Neighbours in a list help each other: the nearest triangle of one is near the next one. In lists of fixed length, so that
/// nothing depends on the number of threads.
constexpr std::size_t kChunk = 64;
std::size_t chunks(std::size_t count) { return (count + kChunk - 1) / kChunk; }

class Cover {
public:
    Cover(const TriangleTree& mesh, const ReachOptions& options, std::vector<Piece>* left)
        : mesh_(mesh), options_(options), left_(left), coordinate_(std::max(options.coordinate, mesh.size())) {}

    /// The part with the largest bound is always next.
    void operator()(const Piece& piece, Reach& reach) {
        pool_.clear(), queue_.clear(), free_.clear();
        known_ = 0;
        add(piece);
        if (piece.hint == TriangleTree::none) pool_[0].hint = hint_;
        for (std::size_t part = 0; !queue_.empty(); ++part) {
            const auto [upper, slot] = queue_.front();
            if (upper <= good() || part == options_.parts) {  // so are all others
                reach.upper = std::max(reach.upper, upper);
                reach.spent = reach.spent || upper > good();
                return;
            }
            std::pop_heap(queue_.begin(), queue_.end());
            queue_.pop_back();
            const Piece next = pool_[slot];
            free_.push_back(slot);
            settle_or_split(next, reach);
        }
    }

private:
    double good() const { return left_ ? options_.good : std::max(options_.good, known_ * (1 + options_.gap)); }
    void add(const Piece& piece) {
        std::size_t slot = pool_.size();
        if (free_.empty()) pool_.push_back(piece);
        else slot = free_.back(), free_.pop_back(), pool_[slot] = piece;
        queue_.emplace_back(piece.upper, slot);
        std::push_heap(queue_.begin(), queue_.end());
    }

    /// Bounds the distance of a piece by that of its vertices from one triangle: distance from a convex set is convex. Returns the worst.
    int bound(Piece& piece, std::uint32_t triangle) const {
        const auto& target = mesh_.corners(triangle);
        double most = 0;
        int worst = 0;
        for (int k = 0; k < piece.size; ++k)
            if (const double d = distance(piece.x[k], nearest_of_triangle(piece.x[k], target)); d > most) most = d, worst = k;
        piece.upper = std::min(piece.upper, most * kSafe + (kNear + piece.cuts * kCut) * coordinate_);
        return worst;
    }

    void settle_or_split(Piece piece, Reach& reach) {
        if (piece.hint != TriangleTree::none && (bound(piece, piece.hint), piece.upper <= good())) return take(piece, reach);
        const TriangleTree::Nearest near = mesh_.nearest(centre_of(piece), piece.hint);
        piece.hint = hint_ = near.triangle;
        const auto& target = mesh_.corners(near.triangle);
        const int worst = bound(piece, near.triangle);
        if (piece.upper <= good()) return take(piece, reach);

        const auto [i, j] = diameter(piece);
        const Point across = piece.x[j] - piece.x[i];
        const double wide = length(across), fine = 1e-13 * coordinate_;
        const double side = std::max({distance(target[0], target[1]), distance(target[1], target[2]), distance(target[2], target[0])});
        if (wide <= 4 * side) {
            // Is the distance that large? Then there is nothing to gain.
            const double there = mesh_.nearest(piece.x[worst], near.triangle).distance;
            known_ = std::max(known_, there);
            if (there > reach.seen) reach.seen = there, reach.at = piece.x[worst], reach.at_slack = piece.cuts * kCut * coordinate_, reach.triangle = piece.triangle;
            if (left_ && there > options_.good) return left_->push_back(piece);
            if (piece.upper <= there * (1 + options_.gap) || wide <= 4 * fine) return take(piece, reach);
            if (piece.host != near.triangle && cut_along_sides(piece, near.triangle, fine)) return;
        }
        bisect(piece, across, 0.5 * (piece.x[i] + piece.x[j]), fine, reach);
    }

    void take(const Piece& piece, Reach& reach) const { reach.upper = std::max(reach.upper, piece.upper); }

    /// Cuts off what is beyond the sides of a triangle of the mesh. False where that changes nothing.
    bool cut_along_sides(const Piece& piece, std::uint32_t triangle, double fine) {
        const auto& t = mesh_.corners(triangle);
        const Point normal = cross(t[1] - t[0], t[2] - t[0]);
        Piece rest = piece, inside, outside;
        std::array<Piece, 3> beyond;
        int count = 0;
        for (int k = 0; k < 3 && rest.size > 0; ++k) {
            const Point inward = cross(normal, t[(k + 1) % 3] - t[k]);
            if (!(length(inward) > 0) || !cut(rest, inward, t[k], fine, inside, outside)) return false;
            if (outside.size > 0) beyond[count++] = outside;
            rest = inside;
        }
        if ((rest.size > 0) + count < 2) return false;
        for (int k = 0; k < count; ++k) beyond[k].host = TriangleTree::none, add(beyond[k]);
        if (rest.size > 0) rest.host = triangle, add(rest);
        return true;
    }

    void bisect(const Piece& piece, const Point& across, const Point& middle, double fine, Reach& reach) {
        Piece above, below;
        if (piece.size < Piece::most && cut(piece, across, middle, fine, above, below) && above.size > 0 && below.size > 0) {
            add(above), add(below);
        } else if (piece.size > 3) {  // along a diagonal, which moves nothing
            above = below = piece;
            const int half = piece.size / 2;
            above.size = half + 1;
            below.size = 0;
            for (int k = half; k <= piece.size; ++k) below.x[below.size++] = piece.x[k % piece.size];
            add(above), add(below);
        } else {
            take(piece, reach);
        }
    }

    const TriangleTree& mesh_;
    const ReachOptions& options_;
    std::vector<Piece>* const left_;
    const double coordinate_;
    std::uint32_t hint_ = TriangleTree::none;
    double known_ = 0;                                    // the largest distance that was seen at the piece
    std::vector<Piece> pool_;                             // its parts
    std::vector<std::size_t> free_;                       // places of the pool
    std::vector<std::pair<double, std::size_t>> queue_;   // those to be looked at, the largest bound first
};

}  // namespace

Farthest farthest_point(std::size_t count, const std::function<Point(std::size_t)>& point, const TriangleTree& mesh) {
    // A few points tell what there is to beat; then most others are settled by the triangle that was nearest to one before them.
    constexpr std::size_t kStride = 61;
    const auto farthest = [&](std::size_t number, std::size_t stride, const Farthest& known) {
        return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, chunks(number)), known, [&](const auto& range, Farthest best) {
            for (std::size_t chunk = range.begin(); chunk < range.end(); ++chunk) {
                std::uint32_t hint = TriangleTree::none;
                Farthest far = known;
                for (std::size_t i = chunk * kChunk; i < std::min(number, (chunk + 1) * kChunk); ++i) {
                    const Point p = point(i * stride);
                    if (hint != TriangleTree::none && distance(p, nearest_of_triangle(p, mesh.corners(hint))) <= far.distance) continue;
                    const auto near = mesh.nearest(p, hint);
                    hint = near.triangle;
                    if (near.distance > far.distance) far = {i * stride, near.distance};
                }
                if (far.distance > best.distance) best = far;
            }
            return best;
        }, [](const Farthest& a, const Farthest& b) { return b.distance > a.distance ? b : a; });
    };
    return farthest(count, 1, farthest((count + kStride - 1) / kStride, kStride, Farthest{}));
}

Reach reach_of(std::size_t count, const std::function<Piece(std::size_t)>& piece, const TriangleTree& mesh, const ReachOptions& options) {
    const std::size_t end = chunks(count), step = end / 50 + 16;
    std::vector<std::vector<Piece>> left(options.left ? end : 0);
    const auto of_chunks = [&](const auto& range, Reach reach) {
        for (std::size_t chunk = range.begin(); chunk < range.end(); ++chunk) {
            Cover cover(mesh, options, options.left ? &left[chunk] : nullptr);
            for (std::size_t i = chunk * kChunk; i < std::min(count, (chunk + 1) * kChunk); ++i) cover(piece(i), reach);
        }
        return reach;
    };
    const auto both = [](const Reach& a, const Reach& b) {
        Reach r = b.seen > a.seen ? b : a;
        r.upper = std::max(a.upper, b.upper), r.spent = a.spent || b.spent;
        return r;
    };
    Reach all;
    for (std::size_t first = 0; first < end; first += step) {
        const std::size_t last = std::min(end, first + step);
        all = both(all, tbb::parallel_reduce(tbb::blocked_range<std::size_t>(first, last), Reach{}, of_chunks, both));
        if (options.progress) options.progress(double(last) / double(end));
    }
    for (const auto& pieces : left) options.left->insert(options.left->end(), pieces.begin(), pieces.end());
    return all;
}

}  // namespace isoparm
