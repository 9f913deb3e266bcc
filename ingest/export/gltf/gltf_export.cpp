#include "ingest/export/gltf/gltf_export.hpp"

#include <fmt/format.h>

#include <optional>

#include "base/files/file.hpp"
#include "ingest/export/gltf/body_figure.hpp"
#include "ingest/export/gltf/gltf_writer.hpp"
#include "ingest/export/skeletons.hpp"

namespace actformer::ingest {
namespace {

class GltfExport : public ExportFile {
  public:
    GltfExport(std::filesystem::path path, const ExportContext& context)
        : path_(std::move(path)), context_(context) {
        if (context.body) figure_ = body_figure(*context.body);
    }

    void add(const ExportClip& clip) override {
        bytes_ = glb_bytes(skeletons_of(clip, context_.pose), context_.subjects.fps, clip.name,
                           figure_ ? &*figure_ : nullptr);
    }

    std::vector<std::filesystem::path> finish() override {
        write_whole(path_, bytes_, context_.sync);
        return {path_};
    }

    std::string note() const override {
        return figure_ ? fmt::format(
                             "{}: the mean body, without pose blend shapes, for which glTF has no place, and "
                             "with "
                             "the four largest weights of every vertex",
                             context_.body->name)
                       : "";
    }

  private:
    std::filesystem::path path_;
    const ExportContext& context_;
    std::optional<SkinFigure> figure_;
    std::string bytes_;
};

}  // namespace

std::unique_ptr<ExportFile> open_gltf(const std::filesystem::path& path, const ExportContext& context) {
    return std::make_unique<GltfExport>(path, context);
}

}  // namespace actformer::ingest
