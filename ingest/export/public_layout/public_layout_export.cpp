#include "ingest/export/public_layout/public_layout_export.hpp"

#include "ingest/dataset/motions_file.hpp"

namespace actformer::ingest {
namespace {

class PublicLayoutExport : public ExportFile {
  public:
    PublicLayoutExport(const std::filesystem::path& path, const ExportContext& context)
        : path_(path), note_(context.public_names_note), writer_(path, context.sync) {
        writer_.describe(context.subjects);
        writer_.note("program", "actformer " ACTFORMER_VERSION);
        writer_.note("source", context.source);
    }

    void add(const ExportClip& clip) override {
        writer_.add(clip.public_name, clip.motion, {clip.label, clip.body.bone_length});
    }

    std::vector<std::filesystem::path> finish() override {
        writer_.finish();
        return {path_};
    }

    std::string note() const override { return note_; }

  private:
    std::filesystem::path path_;
    std::string note_;
    MotionsWriter writer_;
};

}  // namespace

std::unique_ptr<ExportFile> open_public_layout(const std::filesystem::path& path,
                                               const ExportContext& context) {
    return std::make_unique<PublicLayoutExport>(path, context);
}

}  // namespace actformer::ingest
