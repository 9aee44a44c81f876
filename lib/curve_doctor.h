// curve_doctor.h -- why curves do not fit, and which exact change repairs it: another order, another direction.
//
// Pure geometry: nothing is moved, cut or reparametrised, so a repaired surface is spanned by the very curves given. The data as given
// are preferred when they fit; else the repair with the fewest changes (a curve in another place and a curve reversed count one each),
// then the fewest reversals, then the smallest order. "Fits" is what make_* demands (patches/compatibility.h).
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "patches/coons.h"
#include "patches/coons_hermite.h"

namespace isoparm {

/// Place k takes the curve given as order[k], run backwards when reversed[k].
struct Repair {
    std::vector<int> order;
    std::vector<bool> reversed;
    /// The curves (or what belongs to them) in their places.
    std::vector<Curve> operator()(const std::vector<Curve>& given) const;
};

template <class R> struct Diagnosis {
    bool fits = false;        // as given: there is nothing to say
    std::optional<R> repair;  // none where nothing exact repairs it
    std::string changes;      // of the repair: "c1 from d0, d0 from c1 reversed"
    std::string misfit;       // what does not fit as given, how far apart, and without a repair what comes nearest to one
};

/// Places c0, c1, d0, d1.
Diagnosis<Repair> diagnose_frame(const CoonsCurves& curves);
/// Places E1: B to C, E2: C to A, E3: A to B. What is given along an edge (derivatives in the direction of its median, normals) goes with it.
Diagnosis<Repair> diagnose_triangle(const std::array<Curve, 3>& edges);
/// Places c and d, which start at the same point.
Diagnosis<Repair> diagnose_common_start(const Curve& c, const Curve& d);

/// Sides in the order g[0], g[3], f[0], f[3]: x(u,0), x(u,1), x(0,v), x(1,v), each with its cross derivative g[1], g[2], f[1], f[2].
struct HermiteRepair {
    Repair sides;
    std::vector<bool> cross_reversed, negated;  // of the cross derivative in place k
    HermiteData operator()(const HermiteData& given) const;
};
/// Positions, tangents at the corners, and with Twist::compatible the twists decide; a cross derivative may be reversed with its curve
/// or without it, and negated. Costs of a cross derivative: one when it is not reversed as its curve, one when it is negated.
Diagnosis<HermiteRepair> diagnose_hermite(const HermiteData& data, Twist twist);

/// u_curves[j] = x(u, v_nodes[j]), v_curves[i] = x(u_nodes[i], v), run as run_over_nodes() says (patches/gordon.h).
struct CurveNetwork {
    std::vector<Curve> u_curves, v_curves;
    std::vector<double> u_nodes, v_nodes;
    std::string u_name = "u_curves", v_name = "v_curves";  // for the text
    bool nodes_are_given = true;                           // so that "move the node" is advice
};
/// When `swapped`, u takes its curves from v_curves, and v from u_curves.
struct NetworkRepair {
    bool swapped = false;
    Repair u, v;
};
/// Of equally cheap repairs, the first in an order that tries the curve given for a place before the others. Searches at most 100 000
/// crossings, and two million comparisons; then the repair is the cheapest found, and the text says if none was.
/// As many u_curves as v_nodes and v_curves as u_nodes, or the other way round (then they can only be swapped).
Diagnosis<NetworkRepair> diagnose_network(const CurveNetwork& network);

}  // namespace isoparm
