#include "ingest/dataset/shard.hpp"

#include "base/checksum/checksum.hpp"
#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"

namespace actformer::ingest {
namespace {

// About 80 kB a chunk for one person of 25 joints: small enough to draw a window from, large enough to stream.
constexpr hsize_t frames_a_chunk = 256;

constexpr auto motion_array = "motion";

constexpr std::size_t most_of_an_attribute = 60'000;  ///< bytes

template <typename T, typename Of>
std::vector<T> column(const std::vector<Clip>& clips, Of of) {
    std::vector<T> out;
    out.reserve(clips.size());
    for (const auto& clip : clips) out.push_back(static_cast<T>(of(clip)));
    return out;
}

}  // namespace

void ShardBuilder::add(const std::vector<Clip>& clips, kernels::CleanedBatch cleaned) {
    for (auto clip : clips) {
        clip.offset = frames_;
        frames_ += clip.frames;
        clips_.push_back(std::move(clip));
    }
    pieces_.push_back(std::move(cleaned));
}

std::uint64_t ShardBuilder::bytes() const {
    std::uint64_t numbers = 0;
    for (const auto& piece : pieces_) numbers += piece.motion.size();
    return numbers * sizeof(float);
}

ShardImage ShardBuilder::image(hdf5::FileMemory& memory, const std::string& settings,
                               const std::string& fingerprint) {
    std::vector<std::span<const float>> motion;
    std::vector<float> bones;
    for (const auto& piece : pieces_) {
        motion.push_back(piece.motion);
        bones.insert(bones.end(), piece.bone_length.begin(), piece.bone_length.end());
    }
    const hsize_t n = clips_.size(), p = header_->persons, joints = header_->topology.joints();
    hdf5::Writer file(memory, frames_ * header_->frame_values() * sizeof(float));
    file.attribute("program", "actformer " ACTFORMER_VERSION);
    file.attribute("dataset", header_->name);
    // An attribute of HDF5 has 64 KiB at most, and settings name every class.
    file.attribute("settings", settings.size() <= most_of_an_attribute
                                   ? settings
                                   : "in dataset.json, of checksum " + checksum(settings));
    file.attribute("source", fingerprint);
    file.write_pieces(motion_array, {frames_, p, header_->nodes(), header_->representation.numbers()}, motion,
                      frames_a_chunk);
    pieces_.clear();
    file.write<std::uint64_t>("clip/offset", {n},
                              column<std::uint64_t>(clips_, [](auto& c) { return c.offset; }));
    file.write<std::uint32_t>("clip/length", {n},
                              column<std::uint32_t>(clips_, [](auto& c) { return c.frames; }));
    file.write<std::uint32_t>("clip/label", {n},
                              column<std::uint32_t>(clips_, [](auto& c) { return c.label; }));
    file.write_strings("clip/name", column<std::string>(clips_, [](auto& c) { return c.name; }));
    for (std::size_t f = 0; f < header_->fields.size(); ++f)
        file.write_strings("clip/" + header_->fields[f],
                           column<std::string>(clips_, [f](auto& c) { return c.fields[f]; }));
    file.write<float>("clip/bone_length", {n, p, joints}, bones);
    const auto bytes = file.image();
    auto contents = file.contents(), metadata = file.metadata(motion_array);
    return {std::move(file), bytes, std::move(contents), std::move(metadata)};
}

std::vector<Clip> read_clips(const std::filesystem::path& path, const DatasetHeader& header,
                             std::uint32_t shard, const std::string& metadata) {
    const hdf5::Reader file(path);
    if (!metadata.empty() && file.metadata(motion_array) != metadata)
        throw Error(
            "{}: the names, labels or other metadata of its clips are not those that dataset.json has the "
            "checksum of: "
            "changed or damaged; copy it again, or ingest the raw data again",
            path.string());
    const auto motion = file.shape(motion_array);
    const auto numbers = header.representation.numbers();
    if (motion.size() != 4 || motion[1] != header.persons || motion[2] != header.nodes() ||
        motion[3] != numbers)
        throw Error("{}: 'motion' is not (frames, {}, {}, {}) as dataset.json says", path.string(),
                    header.persons, header.nodes(), numbers);
    const auto offsets = file.read<std::uint64_t>("clip/offset");
    const auto lengths = file.read<std::uint32_t>("clip/length"),
               labels = file.read<std::uint32_t>("clip/label");
    const auto names = file.read_strings("clip/name");
    std::vector<std::vector<std::string>> fields;
    for (const auto& field : header.fields) fields.push_back(file.read_strings("clip/" + field));

    const auto n = names.size();
    bool fits = offsets.size() == n && lengths.size() == n && labels.size() == n &&
                file.shape("clip/bone_length") == hdf5::Shape{n, header.persons, header.topology.joints()};
    for (const auto& field : fields) fits = fits && field.size() == n;
    if (!fits) throw Error("{}: the columns of 'clip' do not fit each other: damaged", path.string());

    std::vector<Clip> clips(n);
    for (std::size_t i = 0; i < n; ++i) {
        clips[i] = {names[i], labels[i], shard, offsets[i], lengths[i], {}};
        for (const auto& field : fields) clips[i].fields.push_back(field[i]);
        if (lengths[i] == 0 || offsets[i] > motion[0] || lengths[i] > motion[0] - offsets[i])
            throw Error("{}: clip {} lies outside the motion: damaged", path.string(), names[i]);
        if (labels[i] >= header.classes.size())
            throw Error("{}: clip {} has label {} of {} classes", path.string(), names[i], labels[i],
                        header.classes.size());
    }
    return clips;
}

std::string shard_name(std::size_t number) {
    return fmt::format("shard-{:05}.h5", number);
}

}  // namespace actformer::ingest
