#include "ingest/formats/uestc/uestc_command.hpp"

#include "ingest/formats/uestc/uestc_format.hpp"

namespace actformer::ingest {

std::vector<Option> UestcCommand::list() {
    auto options = rotations.list();
    options.emplace_back(
        "--published",
        "The camera's frame, y down, as the public tools and the recognisers trained with them have it", "",
        &published);
    return options;
}

std::unique_ptr<Format> UestcCommand::open(const std::string& dataset) const {
    return std::make_unique<UestcFormat>(dataset, rotations.target(), published);
}

}  // namespace actformer::ingest
