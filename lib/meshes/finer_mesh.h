// finer_mesh.h -- a mesh that stands for a surface while another one is compared with it; internal to verify.cpp.
#pragma once
#include <memory>

#include "meshes/triangle_tree.h"
#include "tessellate.h"

namespace isoparm {

class FinerMesh {
public:
    /// Within `error`, both ways. Throws what tessellate() throws.
    FinerMesh(const Composite& surface, double error, std::size_t max_triangles, const std::function<void(double)>& progress);

    const TriangleMesh& mesh() const { return mesh_; }
    const TriangleTree& tree() const { return *tree_; }
    /// Proved: no point of the surface, or of this mesh, is farther than that from the other.
    double error() const { return error_; }

    /// A place of the surface: a vertex, or the parameters in the middle of a triangle.
    struct Place {
        std::size_t member = 0;
        Vec2 uv;
        bool flipped = false;  // the mesh winds against S_u x S_v there
    };
    std::size_t places() const { return mesh_.points.size() + middles_.size(); }
    /// Near the surface's point there.
    const Point& near(std::size_t place) const { return place < mesh_.points.size() ? mesh_.points[place] : middles_[place - mesh_.points.size()]; }
    Place place(std::size_t i) const;
    /// The parameters of a point of a triangle.
    Place place_in(std::size_t triangle, const Point& p) const;

    std::vector<std::array<Point, 2>> open_edges() const;

private:
    const MeshPart& part_of(std::size_t triangle, std::size_t& local) const;

    std::vector<MeshPart> parts_;
    std::vector<std::size_t> first_;  // triangle of each part
    TriangleMesh mesh_;
    std::unique_ptr<const TriangleTree> tree_;
    std::vector<Point> middles_;
    double error_ = 0;
};

}  // namespace isoparm
