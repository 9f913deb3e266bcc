#include "ingest/export/bvh/bvh_export.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "ingest/export/bvh/bvh_writer.hpp"
#include "ingest/export/fit_name.hpp"
#include "ingest/export/foreign.hpp"
#include "ingest/export/skeletons.hpp"

namespace actformer::ingest {
namespace {

namespace fs = std::filesystem;

class BvhExport : public ExportFile {
  public:
    BvhExport(fs::path path, const ExportContext& context)
        : path_(std::move(path)),
          context_(context),
          names_(fit_names(context.subjects.topology.names, NameFor::bvh)) {}

    void add(const ExportClip& clip) override {
        auto persons = skeletons_of(clip, context_.pose);
        for (std::size_t p = 0; p < persons.size(); ++p) {
            persons[p].topology.names = names_;
            const auto path = persons.size() == 1 ? path_ : of_person(p + 1);
            if (!context_.force) refuse_foreign(path);
            auto& file = files_.emplace_back(path, std::make_unique<Aside>(path, context_.sync)).second;
            file->write(bvh_text(persons[p], context_.subjects.fps));
            file->settle();
        }
    }

    std::vector<fs::path> finish() override {
        std::vector<fs::path> paths;
        try {
            for (auto& [path, file] : files_) {
                file->commit();
                paths.push_back(path);
            }
        } catch (const Error&) {
            std::error_code ignored;
            for (const auto& path : paths) fs::remove(path, ignored);
            throw;
        }
        return paths;
    }

    std::string note() const override {
        return names_changed(context_.subjects.topology.names, names_, "joint name");
    }

  private:
    fs::path of_person(std::size_t person) const {
        return path_.parent_path() / fmt::format("{}_p{}.bvh", path_.stem().string(), person);
    }

    fs::path path_;
    const ExportContext& context_;
    std::vector<std::string> names_;
    std::vector<std::pair<fs::path, std::unique_ptr<Aside>>> files_;
};

}  // namespace

std::unique_ptr<ExportFile> open_bvh(const fs::path& path, const ExportContext& context) {
    return std::make_unique<BvhExport>(path, context);
}

}  // namespace actformer::ingest
