#include "ingest/formats/ntu/ntu_command.hpp"

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
               "", &join_tracks)};
}

std::unique_ptr<Format> NtuCommand::open(const std::string&) const {
    NtuOptions options;
    if (!missing.empty()) options.missing = read_missing_list(missing);
    options.bodies = bodies == "motion" ? BodyRule::motion : BodyRule::frames;
    options.join_tracks = join_tracks;
    return std::make_unique<NtuFormat>(std::move(options));
}

}  // namespace actformer::ingest
