#include "ingest/formats/nturecon/nturecon_command.hpp"

#include "ingest/formats/nturecon/nturecon_format.hpp"

namespace actformer::ingest {

std::unique_ptr<Format> NtuReconCommand::open(const std::string& dataset) const {
    return std::make_unique<NtuReconFormat>(dataset, rotations.target());
}

}  // namespace actformer::ingest
