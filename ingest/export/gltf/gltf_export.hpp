// Clips to glTF files.
#pragma once

#include "ingest/export/export_format.hpp"

namespace actformer::ingest {

/// One clip, as glb_bytes writes it.
std::unique_ptr<ExportFile> open_gltf(const std::filesystem::path& path, const ExportContext& context);

}  // namespace actformer::ingest
