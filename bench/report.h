// report.h -- what was measured, for people and for programs.
#pragma once
#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace isoparm::bench {

struct Measured {
    std::string table, name, unit, clock;
    bool reference = false;
    std::vector<double> rates;  // unit/s, one a repetition
    std::vector<std::pair<std::string, double>> facts;

    double median() const;  // ratios are taken of these: a single best may have met a faster clock
    double best() const;
};

struct Place {
    std::string machine;
    double load_before = -1, load_after = -1;
};

void write_tables(std::ostream& out, const Place& place, const std::vector<Measured>& all);
void write_json(std::ostream& out, const Place& place, const std::vector<Measured>& all);

}  // namespace isoparm::bench
