#include "ingest/formats/uestc/uestc_command.hpp"

#include "ingest/formats/uestc/uestc_format.hpp"

namespace actformer::ingest {

std::unique_ptr<Format> UestcCommand::open(const std::string& dataset) const {
    return std::make_unique<UestcFormat>(dataset, rotations.target());
}

}  // namespace actformer::ingest
