#include "patches/basis.h"

#include <cmath>
#include <string>

#include "error.h"

namespace isoparm {

void check_nodes(const std::string& name, const std::vector<double>& nodes, std::size_t curves) {
    if (nodes.size() != curves)
        throw_input(name + ": found " + std::to_string(nodes.size()) + " nodes for " + std::to_string(curves) + " curves, expected one for each");
    if (nodes.size() < 2 || nodes.size() > most_nodes)
        throw_input(name + ": found " + std::to_string(nodes.size()) + " nodes, expected 2 to " + std::to_string(most_nodes));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!std::isfinite(nodes[i])) throw_input(name + ": node " + std::to_string(i) + " is not finite");
        if (i > 0 && !(nodes[i - 1] < nodes[i]))
            throw_input(name + ": found node " + std::to_string(i) + " = " + to_text(nodes[i]) + " after " + to_text(nodes[i - 1]) + ", expected nodes that grow");
    }
}

}  // namespace isoparm
