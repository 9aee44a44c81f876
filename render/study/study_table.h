// study_table.h -- the rows of a study and what its columns mean, as CSV and JSON.
#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "study.h"

namespace isoparm {

/// A finished run, and what it depended on.
struct StudyRow {
    StudyRun run;
    std::string key;                // digest of all that the run depends on
    int threads = 1;                // that it had
    std::vector<std::string> heat;  // pictures, relative to the folder: certified, sampled; or none
};

/// A value as text: numbers read back as the same doubles, empty when there is none.
struct StudyColumn {
    const char *name, *unit, *meaning;
    bool number;
    std::string (*value)(const std::vector<StudyRow>& rows, std::size_t i);
};
/// The one description of the columns: of study.csv, study.json and the page. The rows of a method come from coarse to fine.
const std::vector<StudyColumn>& study_columns();

/// The order between this row and the coarser one of the same method before it; nothing without.
std::optional<double> local_order(const std::vector<StudyRow>& rows, std::size_t i);
/// Fitted to all rows of a method that reached their tolerance.
struct MethodOrders {
    std::optional<FittedOrder> certified, sampled;
};
MethodOrders fitted_orders(const std::vector<StudyRow>& rows, const std::string& method);

/// RFC 4180.
void write_csv(std::ostream& out, const std::vector<StudyRow>& rows);
/// One object with a member for each column.
std::string row_json(const std::vector<StudyRow>& rows, std::size_t i);

}  // namespace isoparm
