// The rows of sweeps side by side, whatever tables they fill: a table a dataset, with all that scores tell.
#pragma once

#include <deque>
#include <vector>

#include "reports/page/tables.hpp"

namespace actformer::reports {

/// Rows are held together by sweep, dataset (its name, and the fingerprint that the scores tell), split, window and recogniser: those were
/// scored against the same motions. The last row of a table is what real motions come to: their own value, or, of a distance, that of real
/// motions to other real ones. Points into `measured`.
class RowTables {
  public:
    explicit RowTables(const Measured& measured);

    const std::vector<FilledTable>& filled() const { return filled_; }

  private:
    std::deque<PaperTable> tables_;  ///< what `filled_` points to
    std::vector<FilledTable> filled_;
};

}  // namespace actformer::reports
