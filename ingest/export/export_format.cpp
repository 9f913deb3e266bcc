#include "ingest/export/export_format.hpp"

#include <algorithm>

#include "ingest/export/bvh/bvh_export.hpp"
#include "ingest/export/gltf/gltf_export.hpp"
#include "ingest/export/npz/npz_export.hpp"
#include "ingest/export/public_layout/public_layout_export.hpp"

namespace actformer::ingest {

const std::vector<ExportFormat>& export_formats() {
    static const std::vector<ExportFormat> formats{
        {"h5", "motions as the networks have them, in the public layout", true, false, false,
         open_public_layout},
        {"npz", "joint positions, for NumPy", true, false, false, open_npz},
        {"bvh", "a skeleton that moves, a file a person", false, true, false, open_bvh},
        {"glb", "glTF 2.0: all persons of a clip in one animated scene", false, true, true, open_gltf}};
    return formats;
}

const ExportFormat* export_format(std::string_view name) {
    const auto found = std::ranges::find(export_formats(), name, &ExportFormat::name);
    return found == export_formats().end() ? nullptr : &*found;
}

}  // namespace actformer::ingest
