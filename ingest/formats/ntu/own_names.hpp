// .skeleton files that are not named as NTU RGB+D's are: what a pattern or a table of labels says of them. One dataset comes of them.
#pragma once

#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "ingest/formats/clip_names.hpp"
#include "ingest/formats/format.hpp"

namespace actformer::ingest {

struct OwnNamesOptions {
    std::string dataset;        ///< the dataset's name
    std::string pattern;        ///< of names and folders, as NamePattern takes it; empty: none
    std::string labels;         ///< path of a LabelsFile; empty: none
    unsigned persons = 0;       ///< persons a clip; 0: one
    std::vector<Split> splits;  ///< over the clips' fields
};

class OwnNames {
  public:
    /// Throws Error where an option makes no sense.
    explicit OwnNames(OwnNamesOptions options);

    /// Notes a file, by its name alone. From many threads at once.
    void note(const RawText& raw);

    /// After the last note(): the dataset, its classes the actions of the files, sorted. Throws Error where no file has a clip.
    DatasetHeader settle();

    /// The clips of a file, at least one, or why there is none.
    std::variant<std::vector<NamedClip>, Rejection> clips_of(const RawText& raw) const {
        return names_.clips_of(raw);
    }

    /// After settle(): what the user should know of names, labels and splits, a line each.
    std::vector<std::string> remarks() const;

    /// All that decides names, labels and persons, as text.
    std::string settings() const;

  private:
    unsigned persons() const { return options_.persons > 0 ? options_.persons : 1; }

    OwnNamesOptions options_;
    ClipNames names_;
    std::mutex noting_;
    std::set<std::string> actions_;
    std::set<std::vector<std::string>> fields_of_clips_;
};

}  // namespace actformer::ingest
