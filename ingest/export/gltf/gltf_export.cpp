#include "ingest/export/gltf/gltf_export.hpp"

#include "base/files/file.hpp"
#include "ingest/export/gltf/gltf_writer.hpp"
#include "ingest/export/skeletons.hpp"

namespace actformer::ingest {
namespace {

class GltfExport : public ExportFile {
  public:
    GltfExport(std::filesystem::path path, const ExportContext& context)
        : path_(std::move(path)), context_(context) {}

    void add(const ExportClip& clip) override {
        bytes_ = glb_bytes(skeletons_of(clip, context_.pose), context_.subjects.fps, clip.name);
    }

    std::vector<std::filesystem::path> finish() override {
        write_whole(path_, bytes_);
        return {path_};
    }

  private:
    std::filesystem::path path_;
    const ExportContext& context_;
    std::string bytes_;
};

}  // namespace

std::unique_ptr<ExportFile> open_gltf(const std::filesystem::path& path, const ExportContext& context) {
    return std::make_unique<GltfExport>(path, context);
}

}  // namespace actformer::ingest
