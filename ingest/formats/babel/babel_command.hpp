// The options of `actformer ingest babel`.
#pragma once

#include "ingest/formats/babel/babel_format.hpp"

namespace actformer::ingest {

struct BabelCommand : IngestCommand {
    BabelOptions babel;

    std::vector<Option> list() override;
    std::unique_ptr<Format> open(const std::string& dataset) const override;
};

inline constexpr std::string_view babel_examples =
    "  actformer ingest babel CMU.tar.bz2 KIT.tar.bz2 babel_v1.0_release.zip -o babel120\n"
    "  actformer ingest babel amass/ babel_v1.0_release/ -o babel60 --categories 60\n"
    "  actformer ingest babel amass/ train.json val.json -o mine --categories 'walk,run,jump,climb'\n"
    "  actformer ingest babel amass/ babel_v1.0_release/ -o published --published\n"
    "Of AMASS, take the package SMPL+H G. A label of BABEL becomes a clip for each of its categories that is "
    "a class;\n"
    "what gives no clip stands in DIR/rejected.csv. train.json and val.json become the splits train and "
    "val.\n";

}  // namespace actformer::ingest
