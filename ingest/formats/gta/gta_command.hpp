// The options of `actformer ingest gta`.
#pragma once

#include "ingest/formats/gta/gta_format.hpp"

namespace actformer::ingest {

struct GtaCommand : IngestCommand {
    GtaOptions gta;

    std::vector<Option> list() override;
    bool one_dataset() const override { return false; }
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view gta_examples =
    "  actformer ingest gta gta_combat_2p.h5 gta_combat_3p.h5 gta_combat_4p.h5 gta_combat_5p.h5 -o gta\n"
    "  actformer ingest gta annotations/train -o jta --persons 2\n"
    "  actformer ingest gta mine_2p.h5 -o mine --root-scale 1\n"
    "How many persons a clip has is what its file says: clips of two go to DIR/gta-2p. Bodies end up in "
    "metres, y up.\n";

}  // namespace actformer::ingest
