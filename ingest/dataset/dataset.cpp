#include "ingest/dataset/dataset.hpp"

#include <algorithm>
#include <cmath>

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/files/nearest_file.hpp"
#include "base/hdf5/reader.hpp"
#include "base/text/suggestion.hpp"
#include "ingest/dataset/dataset_json.hpp"
#include "ingest/dataset/shard.hpp"

namespace actformer::ingest {
namespace fs = std::filesystem;
namespace {

/// Empty where the file is what format 1 wrote, byte for byte.
std::string changed_bytes(const fs::path& path, const ShardEntry& entry) {
    const auto hint = "cut short, changed, or opened for writing by another program";
    const auto bytes = fs::file_size(path);
    if (bytes != entry.bytes)
        return fmt::format("{}: {} bytes, not {}: {}", path.string(), bytes, entry.bytes, hint);
    if (checksum_file(path) == entry.checksum) return {};
    return fmt::format("{}: its checksum differs from dataset.json's: {}", path.string(), hint);
}

/// Looks for numbers that are not finite, as the motion passes by.
class Finite {
  public:
    void see(const std::string& array, std::string_view bytes) {
        if (array != "motion") return;
        const auto* numbers = reinterpret_cast<const float*>(bytes.data());
        const auto count = bytes.size() / sizeof(float);
        bool all = true;
        for (std::size_t i = 0; i < count; ++i) all &= std::isfinite(numbers[i]);
        if (!all && !first_odd_)
            first_odd_ = passed_ + (std::find_if_not(numbers, numbers + count,
                                                     [](float v) { return std::isfinite(v); }) -
                                    numbers);
        passed_ += count;
    }
    const std::optional<std::uint64_t>& first_odd() const { return first_odd_; }  ///< a number's place

  private:
    std::uint64_t passed_ = 0;
    std::optional<std::uint64_t> first_odd_;
};

std::string name_at(const std::vector<Clip>& clips, std::uint64_t frame) {
    for (const auto& clip : clips)
        if (frame >= clip.offset && frame - clip.offset < clip.frames) return clip.name;
    return "none";
}

/// What is wrong with one shard; empty where nothing is.
std::string fault_of(const fs::path& path, const ShardEntry& entry, const DatasetHeader& header) {
    if (!fs::exists(path)) return fmt::format("{}: missing", path.string());
    try {
        if (entry.checksum_of_bytes)
            if (auto fault = changed_bytes(path, entry); !fault.empty()) return fault;
        Finite finite;
        const hdf5::Reader file(path);
        const auto contents = file.contents(
            [&](const std::string& array, std::string_view bytes) { finite.see(array, bytes); });
        if (!entry.checksum_of_bytes && contents != entry.checksum)
            return fmt::format(
                "{}: the checksum of its contents differs from dataset.json's: changed or damaged",
                path.string());
        const auto clips = read_clips(path, header, 0, entry.metadata);
        if (finite.first_odd())
            return fmt::format("{}: clip {} holds numbers that are not finite", path.string(),
                               name_at(clips, *finite.first_odd() / header.frame_values()));
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

}  // namespace

Dataset::Dataset(const fs::path& folder) : folder_(folder) {
    if (!fs::exists(folder / "dataset.json"))
        throw Error("{}: no dataset (no dataset.json in it); actformer ingest makes one{}", folder.string(),
                    fs::exists(folder) ? "" : did_you_mean(folder));
    auto file = read_dataset_json(folder / "dataset.json");
    header_ = std::move(file.header);
    fingerprint_ = std::move(file.fingerprint);
    shards_ = std::move(file.shards);
    remarks_ = std::move(file.remarks);
    for (std::uint32_t shard = 0; shard < shards_.size(); ++shard) {
        auto clips = read_clips(folder / shards_[shard].file, header_, shard, shards_[shard].metadata);
        if (clips.size() != shards_[shard].clips)
            throw Error("{}: {} clips, not {} as dataset.json says; ingest the raw data again",
                        (folder / shards_[shard].file).string(), clips.size(), shards_[shard].clips);
        first_clip_.push_back(clips_.size());
        std::move(clips.begin(), clips.end(), std::back_inserter(clips_));
    }
    for (std::size_t i = 0; i < clips_.size(); ++i)
        if (!by_name_.emplace(clips_[i].name, i).second)
            throw Error("{}: clip {} is there twice", folder.string(), clips_[i].name);
}

std::vector<std::string> Dataset::split_names() const {
    std::vector<std::string> names{"all"};
    for (const auto& split : header_.splits) names.push_back(split.name);
    return names;
}

std::vector<std::size_t> Dataset::split(const std::string& name) const {
    const auto found = std::find_if(header_.splits.begin(), header_.splits.end(), [&](const Split& split) {
        return split.name == name || split.name == printable(name);
    });
    if (found == header_.splits.end() && name != "all") {
        const auto known = split_names();
        auto remedy = suggestion(name, known);
        if (remedy.empty())
            remedy = "; take one of these, or ingest the raw data with --split NAME=FIELD:VALUE,...";
        throw Error("{}: no split '{}'; there is {}{}", folder_.string(), name, fmt::join(known, ", "),
                    remedy);
    }
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < clips_.size(); ++i)
        if (found == header_.splits.end() || found->holds(header_.fields, clips_[i].fields)) out.push_back(i);
    return out;
}

std::optional<std::size_t> Dataset::find(const std::string& name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? std::nullopt : std::optional(found->second);
}

const hdf5::Reader& Dataset::shard_of(const Clip& clip) const {
    if (!open_ || open_shard_ != clip.shard) {
        open_ = std::make_shared<hdf5::Reader>(folder_ / shards_[clip.shard].file);
        open_shard_ = clip.shard;
    }
    return *open_;
}

Motion Dataset::motion(std::size_t clip) const {
    const auto& which = clips_.at(clip);
    return {which.name,
            which.frames,
            header_.persons,
            header_.nodes(),
            header_.representation.numbers(),
            shard_of(which).read_rows("motion", which.offset, which.frames)};
}

std::vector<float> Dataset::bone_length(std::size_t clip) const {
    const auto& which = clips_.at(clip);
    return shard_of(which).read_rows("clip/bone_length", clip - first_clip_[which.shard], 1);
}

BodyModel Dataset::body(std::size_t clip) const {
    return {header_.representation, header_.topology, bone_length(clip), header_.rest};
}

Verification verify_dataset(const fs::path& folder) {
    const auto file = read_dataset_json(folder / "dataset.json");
    Verification found;
    for (const auto& shard : file.shards) {
        found.checksums_of_bytes |= shard.checksum_of_bytes;
        if (auto fault = fault_of(folder / shard.file, shard, file.header); !fault.empty())
            found.faults.push_back(std::move(fault));
    }
    return found;
}

std::vector<fs::path> datasets_at(const fs::path& path) {
    if (!fs::exists(path)) throw Error("{}: no such folder{}", path.string(), did_you_mean(path));
    if (fs::exists(path / "dataset.json")) return {path};
    std::vector<fs::path> found;
    if (fs::is_directory(path))
        for (const auto& entry : fs::directory_iterator(path))
            if (fs::exists(entry.path() / "dataset.json")) found.push_back(entry.path());
    if (found.empty())
        throw Error("{}: no dataset (no dataset.json in it or in a folder of it); actformer ingest makes one",
                    path.string());
    std::sort(found.begin(), found.end());
    return found;
}

fs::path one_dataset_at(const fs::path& path) {
    const auto folders = datasets_at(path);
    if (folders.size() == 1) return folders[0];
    throw Error("{}: holds {} datasets; take one at a time, as in {}", path.string(), folders.size(),
                folders[0].string());
}

std::string dataset_checksum(const fs::path& folder) {
    return checksum_file(folder / "dataset.json");
}

}  // namespace actformer::ingest
