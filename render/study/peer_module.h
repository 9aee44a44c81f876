// peer_module.h -- what the module isoparm_opencascade.so answers: plain C, so that no type of OpenCASCADE's crosses over.
#pragma once

extern "C" {

struct IsoparmPeerError {
    char text[1024];
};

/// A Bezier patch over [0,1]^2: (degree_u + 1) x (degree_v + 1) poles, u-major, x y z each, and as many weights, or null.
struct IsoparmPeerFace {
    int degree_u, degree_v;
    const double* poles;
    const double* weights;
};

/// The mesh of one face: uv and xyz of its nodes, triangles counter-clockwise in (u,v), and the segments of its boundary that no other
/// face shares. Nodes of neighbours on a shared edge have the same coordinates.
struct IsoparmPeerMesh {
    int nodes, triangles, open;
    const double *uv, *xyz;
    const int *corners, *segments;
};
typedef void (*IsoparmPeerSink)(void* user, int face, const IsoparmPeerMesh* mesh);

/// "7.6.3"
const char* isoparm_peer_version(void);
/// A shell of the faces, edges nearer than `join` sewn together; null, and the error filled, when it cannot be made.
void* isoparm_peer_open(const IsoparmPeerFace* faces, int count, double join, IsoparmPeerError* error);
/// BRepMesh_IncrementalMesh on one thread, from nothing. Returns 0 or fills `error`.
int isoparm_peer_mesh(void* shell, double deflection, double angle, IsoparmPeerError* error);
int isoparm_peer_read(void* shell, IsoparmPeerSink sink, void* user, IsoparmPeerError* error);
void isoparm_peer_close(void* shell);
}
