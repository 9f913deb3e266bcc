#include "ingest/formats/ntu13/ntu13_command.hpp"

#include "ingest/formats/ntu13/ntu13_format.hpp"

namespace actformer::ingest {

std::vector<Option> Ntu13Command::list() {
    auto options = rotations.list();
    options.push_back(
        Option("--from", "What becomes the dataset: SMPL's rotations, or 18 of the joints that VIBE found",
               "WHAT", &from)
            .one_of({"rotations", "joints"})
            .with_default());
    options.emplace_back(
        "--published",
        "The camera's frame, y down, as the public tools and the recognisers trained with them have it", "",
        &published);
    return options;
}

std::unique_ptr<Format> Ntu13Command::open(const std::string& dataset) const {
    return std::make_unique<Ntu13Format>(
        Ntu13Options{dataset, from == "joints", rotations.target(), published});
}

}  // namespace actformer::ingest
