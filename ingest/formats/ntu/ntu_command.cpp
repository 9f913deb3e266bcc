#include "ingest/formats/ntu/ntu_command.hpp"

#include "ingest/formats/ntu/name.hpp"
#include "ingest/formats/ntu/ntu_format.hpp"

namespace actformer::ingest {

std::vector<Option> NtuCommand::list() {
    return {Option("--missing", "The list of clips with missing skeletons, to leave out", "LIST", &missing)};
}

std::unique_ptr<Format> NtuCommand::open(const std::string&) const {
    return std::make_unique<NtuFormat>(missing.empty() ? std::unordered_set<std::string>()
                                                       : read_missing_list(missing));
}

}  // namespace actformer::ingest
