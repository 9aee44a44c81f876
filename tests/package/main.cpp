// Uses the installed library as a stranger would: a Coons patch of four lines is the bilinear patch of its corners.
#include <cstdio>
#include <isoparm/curves/line.h>
#include <isoparm/isoparm_version.h>
#include <isoparm/patches/coons.h>

int main() {
    using isoparm::make_line;
    const isoparm::Point a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{1, 1, 1};
    const auto patch = isoparm::make_coons({make_line(a, b), make_line(c, d), make_line(a, c), make_line(b, d)});
    const auto middle = patch.point(0.5, 0.5);
    std::printf("isoparm %s: (%g, %g, %g)\n", ISOPARM_VERSION, middle.x, middle.y, middle.z);
    return middle.x == 0.5 && middle.y == 0.5 && middle.z == 0.25 ? 0 : 1;
}
