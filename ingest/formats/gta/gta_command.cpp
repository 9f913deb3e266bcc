#include "ingest/formats/gta/gta_command.hpp"

namespace actformer::ingest {

std::vector<Option> GtaCommand::list() {
    return {
        Option(
            "--root-scale",
            "What the roots' horizontal positions in .h5 files are multiplied by; the public files have them "
            "divided by 5",
            "S", &gta.root_scale)
            .with_default(),
        Option("--lengths", "gta_adjacency.h5: takes the limbs' lengths from it", "FILE.h5", &gta.lengths),
        Option("--persons", "Of JTA's annotations, the persons seen in most frames (default: all)", "P",
               &gta.persons)};
}

std::unique_ptr<Format> GtaCommand::open(const std::string&) const {
    return std::make_unique<GtaFormat>(gta);
}

}  // namespace actformer::ingest
