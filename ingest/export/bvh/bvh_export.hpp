// Clips to BVH files.
#pragma once

#include "ingest/export/export_format.hpp"

namespace actformer::ingest {

/// NAME.bvh for a clip of one person, else NAME_p1.bvh, NAME_p2.bvh .. for `path` NAME.bvh: all of them appear or none.
std::unique_ptr<ExportFile> open_bvh(const std::filesystem::path& path, const ExportContext& context);

}  // namespace actformer::ingest
