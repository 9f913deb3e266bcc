// BVH and ASF/AMC files as one dataset for the ingest pipeline.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <shared_mutex>
#include <string>
#include <vector>

#include "base/files/file.hpp"
#include "ingest/formats/bvh/bvh_options.hpp"
#include "ingest/formats/bvh/bvh_survey.hpp"
#include "ingest/formats/bvh/recordings.hpp"
#include "ingest/formats/clip_names.hpp"
#include "ingest/formats/format.hpp"

namespace actformer::ingest {

/// All clips have the joints of the commonest skeleton among the files whose actions are wanted, matched by name; offsets, channels
/// and the order of siblings may differ. Persons of a clip are the ROOTs of its file, or files that differ in the field {person}.
class BvhFormat : public Format {
  public:
    /// Throws Error where an option makes no sense.
    explicit BvhFormat(BvhOptions options);

    std::vector<std::string_view> extensions() const override { return {".bvh", ".amc", ".asf"}; }

    Survey surveys() const override { return Survey::texts; }
    void survey(const RawText& raw) override;

    /// Takes skeleton, root, rate, persons and scale from the files surveyed, and the classes from their names. Throws Error where no
    /// name fits, no file is sound, none of the classes is among the actions, or there is no such root.
    void settle() override;

    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    bool drops_empty_classes() const override { return options_.classes.empty(); }
    std::string settings() const override;
    std::vector<std::string> remarks() const override { return decision_.remarks; }
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

  private:
    using Paths = std::vector<std::string>;

    /// An .amc whose skeleton had not come yet when it did.
    struct Waiting {
        std::string path, stem, text, inside;
        std::uint64_t index = 0;

        RawText raw() const {
            return {path, stem, std::string_view(text).substr(0, text.size() - text_padding), inside, index};
        }
    };

    bool is_wanted(const std::vector<NamedClip>& clips) const;
    void look_at(const RawText& raw);
    std::vector<std::string> wanted_classes() const;
    void remark_classes(const std::vector<std::string>& classes);
    void gather_groups();

    const Paths* group_of(const RawText& raw) const;
    std::variant<std::vector<Recording>, Rejection> persons_of(const RawText& raw, const Paths* group) const;
    std::optional<Rejection> fit(std::vector<Recording>& persons, std::vector<Skeleton>& skeletons) const;
    ParsedClip make_clip(const NamedClip& named, const std::vector<Recording>& persons,
                         const std::vector<Skeleton>& skeletons) const;

    BvhOptions options_;
    ClipNames names_;
    BvhSettings settings_;
    Recordings recordings_;
    std::shared_mutex surveying_;
    BvhSurvey survey_;
    std::set<std::string> actions_;                       ///< of all names
    std::set<std::vector<std::string>> fields_of_clips_;  ///< of the classes wanted
    std::string fault_;                                   ///< of the first file that fits and is not sound
    std::uint64_t fault_index_ = 0;
    std::vector<Waiting> waiting_;
    std::map<std::string, Paths> groups_;  ///< files that are persons of one clip, in the source's order
    BvhDecision decision_;
    std::vector<DatasetHeader> datasets_;
};

}  // namespace actformer::ingest
