// peer_opencascade.cpp -- the module isoparm_opencascade.so: meshes of Bezier patches by OpenCASCADE's BRepMesh, to be compared with. The
// only file that includes OpenCASCADE; built where it was found.
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom_BezierSurface.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>

#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <vector>

#include "study/peer_module.h"

namespace {

struct Shell {
    TopoDS_Shape shape;
    std::vector<TopoDS_Face> faces;  // as sewn, in the order of the patches
};

template <class F> bool guarded(IsoparmPeerError* error, F f) {
    try {
        f();
        return true;
    } catch (const Standard_Failure& e) {
        std::snprintf(error->text, sizeof error->text, "OpenCASCADE: %s: %s", e.DynamicType()->Name(), e.GetMessageString());
    } catch (const std::exception& e) {
        std::snprintf(error->text, sizeof error->text, "OpenCASCADE: %s", e.what());
    }
    return false;
}

TopoDS_Face face_of(const IsoparmPeerFace& f) {
    TColgp_Array2OfPnt poles(1, f.degree_u + 1, 1, f.degree_v + 1);
    TColStd_Array2OfReal weights(1, f.degree_u + 1, 1, f.degree_v + 1);
    for (int i = 0; i <= f.degree_u; ++i)
        for (int j = 0; j <= f.degree_v; ++j) {
            const int k = i * (f.degree_v + 1) + j;
            poles(i + 1, j + 1) = gp_Pnt(f.poles[3 * k], f.poles[3 * k + 1], f.poles[3 * k + 2]);
            weights(i + 1, j + 1) = f.weights ? f.weights[k] : 1;
        }
    const Handle(Geom_BezierSurface) surface = f.weights ? new Geom_BezierSurface(poles, weights) : new Geom_BezierSurface(poles);
    BRepBuilderAPI_MakeFace make(surface, 1e-7);
    if (!make.IsDone()) throw std::runtime_error("no face can be made of a patch");
    return make.Face();
}

/// Segments of the triangulation along edges of the face that no other face has.
std::vector<int> open_segments(const TopoDS_Face& face, const Handle(Poly_Triangulation) & mesh, const TopLoc_Location& place,
                               const TopTools_IndexedDataMapOfShapeListOfShape& faces_of_edges) {
    std::vector<int> segments;
    for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next()) {
        const TopoDS_Edge& edge = TopoDS::Edge(e.Current());
        if (BRep_Tool::Degenerated(edge) || BRep_Tool::IsClosed(edge, face) || faces_of_edges.FindFromKey(edge).Extent() > 1) continue;
        const Handle(Poly_PolygonOnTriangulation) polygon = BRep_Tool::PolygonOnTriangulation(edge, mesh, place);
        if (polygon.IsNull()) throw std::runtime_error("an edge has no polygon");
        for (int k = 1; k < polygon->NbNodes(); ++k) segments.push_back(polygon->Node(k) - 1), segments.push_back(polygon->Node(k + 1) - 1);
    }
    return segments;
}

}  // namespace

extern "C" {

const char* isoparm_peer_version(void) { return OCC_VERSION_COMPLETE; }

void* isoparm_peer_open(const IsoparmPeerFace* faces, int count, double join, IsoparmPeerError* error) {
    auto shell = std::make_unique<Shell>();
    const bool done = guarded(error, [&] {
        BRepBuilderAPI_Sewing sewing(join);
        std::vector<TopoDS_Face> single;
        for (int k = 0; k < count; ++k) sewing.Add(single.emplace_back(face_of(faces[k])));
        sewing.Perform();
        shell->shape = sewing.SewedShape();
        for (const TopoDS_Face& f : single) {
            const TopoDS_Shape sewn = sewing.IsModified(f) ? sewing.Modified(f) : f;
            if (sewn.ShapeType() != TopAbs_FACE) throw std::runtime_error("sewing cut a face in parts");
            shell->faces.push_back(TopoDS::Face(sewn));
        }
    });
    return done ? shell.release() : nullptr;
}

int isoparm_peer_mesh(void* handle, double deflection, double angle, IsoparmPeerError* error) {
    return !guarded(error, [&] {
        Shell& shell = *static_cast<Shell*>(handle);
        BRepTools::Clean(shell.shape);
        BRepMesh_IncrementalMesh(shell.shape, deflection, false, angle, false);
    });
}

int isoparm_peer_read(void* handle, IsoparmPeerSink sink, void* user, IsoparmPeerError* error) {
    return !guarded(error, [&] {
        const Shell& shell = *static_cast<const Shell*>(handle);
        TopTools_IndexedDataMapOfShapeListOfShape faces_of_edges;
        TopExp::MapShapesAndAncestors(shell.shape, TopAbs_EDGE, TopAbs_FACE, faces_of_edges);
        for (std::size_t f = 0; f < shell.faces.size(); ++f) {
            TopLoc_Location place;
            const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(shell.faces[f], place);
            if (mesh.IsNull()) throw std::runtime_error("a face was not meshed");
            std::vector<double> uv, xyz;
            std::vector<int> corners;
            for (int k = 1; k <= mesh->NbNodes(); ++k) {
                const gp_Pnt2d p = mesh->UVNode(k);
                const gp_Pnt x = mesh->Node(k).Transformed(place.Transformation());
                uv.insert(uv.end(), {p.X(), p.Y()});
                xyz.insert(xyz.end(), {x.X(), x.Y(), x.Z()});
            }
            for (int k = 1; k <= mesh->NbTriangles(); ++k) {
                int a, b, c;
                mesh->Triangle(k).Get(a, b, c);
                corners.insert(corners.end(), {a - 1, b - 1, c - 1});
            }
            const std::vector<int> open = open_segments(shell.faces[f], mesh, place, faces_of_edges);
            const IsoparmPeerMesh result{mesh->NbNodes(), mesh->NbTriangles(), int(open.size() / 2), uv.data(), xyz.data(), corners.data(), open.data()};
            sink(user, int(f), &result);
        }
    });
}

void isoparm_peer_close(void* handle) { delete static_cast<Shell*>(handle); }
}
