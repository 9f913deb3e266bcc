// Arrays of joint positions (.npy, .npz, .csv, .h5) and motions in the public ActFormer layout (.h5) as one dataset.
#pragma once

#include <map>
#include <mutex>
#include <optional>
#include <set>

#include "ingest/formats/clip_names.hpp"
#include "ingest/formats/format.hpp"
#include "ingest/formats/motions/clip_positions.hpp"
#include "ingest/formats/motions/motion_file.hpp"

namespace actformer::ingest {

struct MotionsOptions {
    std::string dataset;          ///< the dataset's name
    std::string topology;         ///< as topology_called takes it; empty: what the files say
    std::string pattern;          ///< of names and folders, as NamePattern takes it; empty: none
    std::string labels;           ///< a LabelsFile; empty: none
    std::string axes;             ///< as JointArray takes them
    std::string up = "y";         ///< axis of the arrays that points up
    std::string representation;   ///< of joint positions in the dataset: limb or xyz; empty: limb
    std::vector<Split> splits;    ///< over the fields
    double fps = 0;               ///< of the recordings; 0: as the files say, else 30
    double scale = 1;             ///< metres a unit of the arrays
    unsigned persons = 0;         ///< of a clip; 0: as many as most clips have
    bool clean = false;           ///< smooth positions as NTU's are
    bool centre_windows = false;  ///< see DatasetHeader
};

/// Limbs and rotations are stored as they are, to the bit; joint positions become limbs, or stay positions.
class MotionsFormat : public Format {
  public:
    /// Throws Error where an option makes no sense.
    explicit MotionsFormat(MotionsOptions options);
    ~MotionsFormat() override;

    std::vector<std::string_view> extensions() const override {
        return {".npy", ".npz", ".csv", ".tsv", ".h5", ".hdf5"};
    }
    std::uint64_t largest_file() const override { return std::uint64_t{1} << 44; }
    Survey surveys() const override { return Survey::texts; }
    void survey(const RawText& raw) override;

    /// Throws Error where no file holds a motion, or what they hold gives no dataset.
    void settle() override;

    const std::vector<DatasetHeader>& datasets() const override { return datasets_; }
    bool drops_empty_classes() const override { return !told_classes_; }
    std::string settings() const override;
    std::vector<std::string> remarks() const override { return remarks_; }
    void read(const RawText& raw, ClipSink& sink) const override;
    kernels::CleanedBatch clean(kernels::Device& device, std::size_t dataset,
                                std::span<const std::unique_ptr<RawClip>> clips,
                                std::vector<std::uint32_t>& frames) const override;

  private:
    struct Surveyed;
    class FileReader;

    void settle_skeleton();
    void settle_header();
    void settle_names();
    void settle_classes();
    void remark();
    std::vector<NamedClip> told_by_file(const Surveyed& file, const FoundMotion& motion,
                                        std::uint64_t clip) const;
    std::variant<std::vector<NamedClip>, Rejection> clips_of(const Surveyed& file, const FoundMotion& motion,
                                                             std::uint64_t clip) const;

    MotionsOptions options_;
    ArrayReading arrays_;
    PositionsRequest positions_;
    std::optional<ClipNames> names_;
    std::mutex surveying_;
    std::map<std::uint64_t, Surveyed> files_;  ///< by index
    std::size_t folders_ = 0;                  ///< before a clip's name, where the files tell the names
    bool told_classes_ = false;                ///< all files tell the same
    std::set<std::vector<std::string>> fields_of_clips_;
    std::vector<std::string> remarks_;
    std::vector<DatasetHeader> datasets_;
};

}  // namespace actformer::ingest
