// Splits are views: a clip is in a split where its metadata satisfies every condition.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace actformer::ingest {

/// `field` is (or, where `negated`, is not) one of `values`.
struct Condition {
    std::string field;
    std::vector<std::string> values;
    bool negated = false;
};

struct Split {
    std::string name;  ///< as in "xsub/train"
    std::vector<Condition> conditions;

    /// `fields` and `values` run alongside. Throws Error where a condition names a field that is not there.
    bool holds(const std::vector<std::string>& fields, const std::vector<std::string>& values) const;
};

/// From the command line: "xstyle/train=style:active,normal", conditions joined by ';', "style!:a,b" for "is not".
/// Fit for print, as clips' fields are. Throws Error showing this form.
Split parse_split(const std::string& given);

/// The same of every text. Throws Error where two splits have one name, or one is called "all", which every clip is in.
std::vector<Split> parse_splits(const std::vector<std::string>& texts);

/// Throws Error naming the split and the fields there are where a condition asks for a field that is not among `fields`.
void check_fields(const std::vector<Split>& splits, const std::vector<std::string>& fields);

/// A line for every split that holds none of the clips, whose values `clips` has, each alongside `fields`: its name, why, and what
/// values there are, as in "split train has no clip: none has subject 99; there are 01, 02, 05, ...".
std::vector<std::string> empty_splits(const std::vector<Split>& splits,
                                      const std::vector<std::string>& fields,
                                      const std::set<std::vector<std::string>>& clips);

/// As settings record them: " [xstyle/train style:active,normal]" for each.
std::string to_text(const std::vector<Split>& splits);

}  // namespace actformer::ingest
