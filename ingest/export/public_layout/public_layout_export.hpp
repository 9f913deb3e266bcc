// Clips to one HDF5 file in the public ActFormer layout, as MotionsWriter writes it.
#pragma once

#include "ingest/export/export_format.hpp"

namespace actformer::ingest {

/// Numbers stay what they are to the bit, in the representation they have; each motion has its label and bone lengths beside it.
std::unique_ptr<ExportFile> open_public_layout(const std::filesystem::path& path,
                                               const ExportContext& context);

}  // namespace actformer::ingest
