#include "study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <numbers>

#include "error.h"
#include "tessellate.h"

namespace isoparm {
namespace {

double processor_time() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

double smallest_angle(const Point& a, const Point& b, const Point& c) {
    const auto angle = [](const Point& at, const Point& p, const Point& q) {
        return std::atan2(length(cross(p - at, q - at)), dot(p - at, q - at));
    };
    return std::min({angle(a, b, c), angle(b, c, a), angle(c, a, b)}) * 180 / std::numbers::pi;
}

double optimal_count(const StudyInput& input) {
    double sum = 0;
    for (const Member& m : input.surface) sum += optimal_triangles(m.patch, input.tolerance);
    return sum;
}

double largest(const TriangleNumbers& numbers) {
    double most = 0;
    for (const auto& part : numbers)
        for (const double x : part) most = std::max(most, x);
    return most;
}

}  // namespace

const StudyMethod* find_study_method(const std::string& name) {
    for (const StudyMethod& m : study_methods())
        if (name == m.name) return &m;
    return nullptr;
}

AngleQuantiles smallest_angles(const Mesh& mesh) {
    std::vector<double> angles;
    for (const MeshPart& part : mesh.parts)
        for (const auto& t : part.triangles) {
            const auto at = [&](int k) -> const Point& { return mesh.positions[part.vertex[t[std::size_t(k)]]]; };
            angles.push_back(smallest_angle(at(0), at(1), at(2)));
        }
    if (angles.empty()) return {};
    std::sort(angles.begin(), angles.end());
    const auto quantile = [&](double q) { return angles[std::size_t(q * double(angles.size() - 1))]; };
    return {angles.front(), quantile(0.01), quantile(0.05), quantile(0.5)};
}

StudyResult run_study(const StudyMethod& method, const StudyInput& input) {
    StudyResult result;
    StudyRun& run = result.run;
    run.method = method.name;
    run.tolerance = input.tolerance;
    run.optimal = optimal_count(input);
    const auto start = std::chrono::steady_clock::now();
    const double processor = processor_time();
    StudyMesh made;
    try {
        made = method.make(input);
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::budget) throw;
        run.reason = e.what();
    }
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    run.processor_seconds = processor_time() - processor;
    if (!run.reason.empty()) return result;

    MeshProof proof = *MeshProver(input.surface)(made.mesh, input.tolerance);
    run.certified_error = std::min(proof.geometric, made.certified_error);
    run.certified_parametric = std::min(proof.parametric, made.certified_parametric);
    run.reached = run.certified_error <= input.tolerance;
    if (!run.reached) run.reason = "the mesh has a certified error of " + to_text(run.certified_error);
    run.triangles = made.mesh.triangle_count();
    run.vertices = made.mesh.positions.size();
    run.angles = smallest_angles(made.mesh);
    result.sampled = sampled_errors(input.surface, made.mesh);
    run.sampled_error = largest(result.sampled);
    result.certified = std::move(proof.bound);
    result.mesh = std::move(made.mesh);
    return result;
}

void sharpen_bounds(const Composite& surface, StudyResult& result) {
    const MeshProof sharp = *MeshProver(surface)(result.mesh, 0);
    for (std::size_t p = 0; p < sharp.bound.size(); ++p)
        for (std::size_t i = 0; i < sharp.bound[p].size(); ++i)
            result.certified[p][i] = std::min(result.certified[p][i], sharp.bound[p][i]);
}

std::optional<FittedOrder> fit_order(const std::vector<double>& triangles, const std::vector<double>& errors) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    std::vector<std::array<double, 2>> points;
    for (std::size_t i = 0; i < std::min(triangles.size(), errors.size()); ++i)
        if (triangles[i] > 0 && errors[i] > 0 && std::isfinite(triangles[i] + errors[i]))
            points.push_back({std::log(triangles[i]), std::log(errors[i])});
    for (const auto& [x, y] : points) n += 1, sx += x, sy += y;
    if (n < 2) return {};
    for (const auto& [x, y] : points) sxx += (x - sx / n) * (x - sx / n), sxy += (x - sx / n) * (y - sy / n);
    if (!(sxx > 0)) return {};
    return FittedOrder{-2 * sxy / sxx, points.size()};
}

std::vector<double> default_tolerances(double diagonal) {
    std::vector<double> list;
    for (int i = 3; i <= 10; ++i) list.push_back(std::pow(10, -0.5 * i) * diagonal);
    return list;
}

}  // namespace isoparm
