#include "rays/exact_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "batch/batch_kernel.h"
#include "release.h"

namespace isoparm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostDepth = 3;            // quarterings of a leaf: 8 x 8 pieces
constexpr double kPerHalving = 1.0 / 50;  // of the error of models of degree 5, when their boxes are halved both ways: 1/64, but for rounding

constexpr double kRough = 20;             // the error of a whole leaf's piece beside what is wanted, which is kept for grazing rays
constexpr double kLeftOut = 0.02;         // by a model, of what its second derivatives amount to over a box, where it tells enough

int degree_with_kernel(int degree) {
    while (degree <= PolynomialCells::max_degree && !batch_kernel(Isa::baseline, degree, false, false)) ++degree;
    return degree;
}

Interval half(const Interval& t, bool upper) { return upper ? Interval(mid(t), t.hi) : Interval(t.lo, mid(t)); }

/// That of 4^step parts of a box which holds (u,v), and its number.
std::pair<Box, std::size_t> part_at(Box box, int step, double u, double v) {
    std::size_t number = 0;
    for (; step > 0; --step) {
        const bool right = u >= mid(box.u), upper = v >= mid(box.v);
        box = {half(box.u, right), half(box.v, upper)}, number = 4 * number + 2 * right + upper;
    }
    return {box, number};
}

/// What `place` holds, made where there is none; of two threads that make it, with the same numbers, one is faster.
template <class T, class Make> const T& made(std::atomic<const T*>& place, Make make) {
    if (const T* known = place.load(std::memory_order_acquire)) return *known;
    std::unique_ptr<T> fresh = make();
    const T* none = nullptr;
    if (place.compare_exchange_strong(none, fresh.get(), std::memory_order_acq_rel, std::memory_order_acquire)) return *fresh.release();
    return *none;
}

}  // namespace

ExactPiece::~ExactPiece() {
    for (const auto& part : parts) delete part.load(std::memory_order_acquire);
}

void ExactPiece::frames(std::size_t n, const double* u, const double* v, double* const* out) const {
    batch_kernel(chosen_isa(), degree, rational, false)(c.data(), mid(box.u), mid(box.v), n, u, v, out);
}

ExactPieces::ExactPieces(const Patch& patch, double size, std::size_t leaves) : patch_(patch), lines_u_(patch.lines_u()), lines_v_(patch.lines_v()), wanted_(wanted * size), roots_(leaves), models_(leaves) {
    for (std::size_t i = 0; i + 1 < lines_u_.size(); ++i)
        for (std::size_t j = 0; j + 1 < lines_v_.size(); ++j) {
            auto form = patch.exact_cell(i, j);
            const bool usable = (form.size() == 3 || form.size() == 4) && std::all_of(form.begin(), form.end(), [](const Polynomial& x) { return x.exists(); });
            forms_.push_back(usable ? std::move(form) : std::vector<Polynomial>{});
        }
}

ExactPieces::~ExactPieces() {
    for (const auto& root : roots_) delete root.load(std::memory_order_acquire);
    for (const auto& model : models_) delete model.load(std::memory_order_acquire);
}

/// Takes a form, centred in the piece's middle, that S is within `rest` of, as its derivatives are, if its error is smaller than what there is.
void ExactPieces::set(ExactPiece& piece, const std::vector<Polynomial>& form, const std::array<double, 3>& rest) const {
    int degree = 1;
    for (const Polynomial& x : form) degree = std::max({degree, x.degree_u(), x.degree_v()});
    degree = degree_with_kernel(degree);
    if (degree > PolynomialCells::max_degree) return;
    const FrameError rounding = frame_error(form, piece.box.u, piece.box.v, 1);
    constexpr double up = 1 + 1e-15;
    const FrameError error{(rounding.position + rest[0]) * up, (rounding.du + rest[1]) * up, (rounding.dv + rest[2]) * up};
    if (!(error.position < piece.error.position) || !std::isfinite(error.du + error.dv)) return;
    piece.error = error, piece.degree = degree, piece.rational = form.size() == 4;
    const auto side = static_cast<std::size_t>(degree) + 1;
    piece.c.assign(form.size() * side * side, 0.0);
    for (std::size_t axis = 0; axis < form.size(); ++axis)
        for (int i = 0; i <= form[axis].degree_u(); ++i)
            for (int j = 0; j <= form[axis].degree_v(); ++j) piece.c[(axis * side + static_cast<std::size_t>(i)) * side + static_cast<std::size_t>(j)] = mid(form[axis].coefficient(i, j));
}

std::unique_ptr<ExactPiece> ExactPieces::make(const Box& box, std::uint32_t cell, int depth, const Model* known) const {
    auto piece = std::make_unique<ExactPiece>();
    piece->box = box, piece->depth = depth;
    piece->error = {kInfinity, kInfinity, kInfinity};
    if (std::vector<Polynomial> form = forms_[cell]; !form.empty()) {
        const std::size_t i = cell / (lines_v_.size() - 1), j = cell % (lines_v_.size() - 1);
        for (Polynomial& x : form) x = x.moved(mid(Interval(lines_u_[i], lines_u_[i + 1])), mid(Interval(lines_v_[j], lines_v_[j + 1])), box.u, box.v);
        set(*piece, form, {0, 0, 0});
    }
    if (good(*piece)) return piece;
    if (const Model model = known ? *known : patch_.model(box); model.size() == 3) {
        const auto largest = [&](double Polynomial::Rest::*of) { return std::max({model[0].rest().*of, model[1].rest().*of, model[2].rest().*of}); };
        set(*piece, model, {largest(&Polynomial::Rest::f), largest(&Polynomial::Rest::u), largest(&Polynomial::Rest::v)});
    }
    if (good(*piece)) return piece;
    if (depth > 0 || piece->error.position > kRough * wanted_) release(piece->c);
    double error = piece->error.position;
    for (int step = 1; step <= kMostDepth - depth; ++step)
        if ((error *= kPerHalving) <= wanted_) {
            piece->step = step, piece->parts = std::vector<std::atomic<const ExactPiece*>>(std::size_t(1) << 2 * step);
            break;
        }
    return piece;
}

const ExactPieces::Model& ExactPieces::model(std::size_t leaf, const Box& box) const {
    return made(models_[leaf], [&] { return std::make_unique<Model>(patch_.model(box)); });
}

std::optional<Enclosure> ExactPieces::enclose(std::size_t leaf, const Box& box, const Box& part) const {
    const Model& known = model(leaf, box);
    if (known.size() != 3) return {};
    const double hu = rad(part.u), hv = rad(part.v);
    double bend = 0, off = 0;  // of second derivatives; of what the model leaves out
    Enclosure e;
    e.u = mid(part.u), e.v = mid(part.v);
    for (int axis = 0; axis < 3; ++axis) {
        const Polynomial& x = known[static_cast<std::size_t>(axis)];
        JetUV<Interval, 2> over;
        x.jets<2>(mid(box.u), mid(box.v), part.u, part.v, &e.centre[axis], &over);
        const Polynomial::Rest& r = x.rest();
        const double rest[] = {r.f, r.u, r.v, 0.5 * r.uu, r.uv, 0.5 * r.vv}, scale[] = {1, hu, hv, hu * hu, hu * hv, hv * hv};
        for (int k = 0; k < 6; ++k) {
            const Interval around(-rest[k], rest[k]);
            e.centre[axis].c[k] = e.centre[axis].c[k] + around, e.over[axis].c[k] = over.c[k] + around;
            off += rest[k] * scale[k];
            if (k > 2) bend += mag(over.c[k]) * scale[k];
        }
    }
    if (!(off <= kLeftOut * bend)) return {};
    return e;
}

const ExactPiece& ExactPieces::root(std::size_t leaf, const Box& box, std::uint32_t cell) const {
    return made(roots_[leaf], [&] { return make(box, cell, 0, forms_[cell].empty() ? &model(leaf, box) : nullptr); });
}

const ExactPiece* ExactPieces::quotient(std::size_t leaf, const Box& box, std::uint32_t cell) const {
    if (forms_[cell].empty()) return nullptr;
    const ExactPiece& piece = root(leaf, box, cell);
    return good(piece) ? &piece : nullptr;
}

const ExactPiece* ExactPieces::rough(std::size_t leaf, const Box& box, std::uint32_t cell) const {
    const ExactPiece& piece = root(leaf, box, cell);
    return piece.c.empty() ? nullptr : &piece;
}

const ExactPiece* ExactPieces::at(std::size_t leaf, const Box& box, std::uint32_t cell, double u, double v) const {
    if (!(box.u.lo <= u && u <= box.u.hi && box.v.lo <= v && v <= box.v.hi)) return nullptr;
    const ExactPiece* piece = &root(leaf, box, cell);
    while (!good(*piece)) {
        if (piece->step == 0) return nullptr;
        const auto [part, number] = part_at(piece->box, piece->step, u, v);
        piece = &made(piece->parts[number], [&, of = part] { return make(of, cell, piece->depth + piece->step, nullptr); });
    }
    return piece;
}

}  // namespace isoparm
