#include "ingest/formats/ntu/ntu_command.hpp"

#include "base/error.hpp"
#include "ingest/formats/ntu/name.hpp"
#include "ingest/formats/ntu/ntu_format.hpp"

namespace actformer::ingest {

std::vector<Option> NtuCommand::list() {
    return {
        Option("--missing", "The list of clips with missing skeletons, to leave out", "LIST", &missing),
        Option("--bodies",
               "Which bodies are the persons: those seen in most frames, as published, or those that move "
               "most, as NTU's authors recommend",
               "RULE", &bodies)
            .one_of({"frames", "motion"})
            .with_default(),
        Option("--join-tracks",
               "Tracks that follow one another in time and place are one body (published tools take the "
               "longest alone)",
               "", &join_tracks),
        Option("--name",
               "What names other than NTU's say: {action}, other {field}s, {*} for the rest; folders too: "
               "{action}/{index}",
               "PATTERN", &own.pattern),
        Option("--labels",
               "A table of files, actions, and more fields, as CSV with a header line: file,action,...",
               "FILE", &own.labels),
        Option("--persons",
               "Persons a clip, with --name or --labels; clips with fewer are left out (default: 1)", "N",
               &own.persons),
        Option("--split", "A split by the fields that --name and --labels tell; may be given again",
               "NAME=FIELD:VALUE,...", &splits)};
}

std::unique_ptr<Format> NtuCommand::open(const std::string& dataset) const {
    NtuOptions options;
    if (!missing.empty()) options.missing = read_missing_list(missing);
    options.bodies = bodies == "motion" ? BodyRule::motion : BodyRule::frames;
    options.join_tracks = join_tracks;
    if (has_own_names()) {
        options.own = own;
        options.own->dataset = dataset;
        options.own->splits = parse_splits(splits);
    } else if (own.persons > 0 || !splits.empty()) {
        throw Error(
            "{} goes with --name or --labels; the persons and splits of files named as NTU's are told by "
            "their "
            "names",
            own.persons > 0 ? "--persons" : "--split");
    }
    return std::make_unique<NtuFormat>(std::move(options));
}

}  // namespace actformer::ingest
