#include "ingest/dataset/motions_file.hpp"

#include <algorithm>
#include <limits>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"
#include "ingest/dataset/layout.hpp"
#include "ingest/dataset/own_kind.hpp"

namespace actformer::ingest {

std::string public_name(const std::string& name, std::uint32_t label) {
    constexpr std::size_t digits = 3;
    const auto numbered = name.find_last_not_of("0123456789");
    if (numbered == std::string::npos || name[numbered] != 'A' || numbered + 1 + digits != name.size())
        return name;
    return fmt::format("{}{:03}", name.substr(0, numbered + 1), label + 1);
}

std::optional<std::uint32_t> read_label(const hdf5::Reader& file, const std::string& name,
                                        const std::string& where) {
    if (!file.has_attribute("label", name)) return {};
    const auto label = file.attribute_numbers("label", name);
    if (label.size() != 1 || label[0] < 0 || label[0] > std::numeric_limits<std::int32_t>::max())
        throw Error("{}: '{}' has a label that is no number from 0", where, name);
    return static_cast<std::uint32_t>(label[0]);
}

MotionDetails read_details(const hdf5::Reader& file, const std::string& name, const std::string& where) {
    MotionDetails details;
    details.label = read_label(file, name, where);
    if (file.has_attribute("bone_length", name))
        details.bone_length = file.attribute_floats("bone_length", name);
    return details;
}

struct MotionsFile::Handle {
    hdf5::Reader reader;
};

MotionsFile::MotionsFile(const std::filesystem::path& path, Representation otherwise)
    : path_(path), file_(new Handle{hdf5::Reader(path)}), representation_(otherwise) {
    refuse_other_than_motions(file_->reader, path.string());
    for (auto& name : file_->reader.names())
        if (file_->reader.is_array(name)) names_.push_back(std::move(name));
    if (names_.empty())
        throw Error("{}: holds no motions; one (P*C, K, T) array a clip is expected", path.string());
    if (const auto told = read_representation(file_->reader, path.string())) {
        representation_ = *told;
        tells_representation_ = true;
    }
    subjects_ = read_subjects(file_->reader, path.string());
}

MotionsFile::MotionsFile(MotionsFile&& other) noexcept = default;
MotionsFile::~MotionsFile() = default;

Motion MotionsFile::read(const std::string& name) const {
    const auto shape = file_->reader.shape(name);
    const auto numbers = representation_.numbers();
    constexpr hsize_t most = std::numeric_limits<std::uint32_t>::max();
    if (shape.size() != 3 || shape[0] == 0 || shape[0] % numbers != 0 || shape[1] == 0 ||
        std::ranges::max(shape) > most)
        throw Error("{}: '{}' is no (P*{}, K, T) array, as {} has them", path_.string(), name, numbers,
                    representation_.name());
    Motion motion{name,
                  static_cast<std::uint32_t>(shape[2]),
                  static_cast<std::uint32_t>(shape[0] / numbers),
                  static_cast<std::uint32_t>(shape[1]),
                  numbers,
                  {}};
    const auto stored = file_->reader.read<float>(name);
    take_channels_first(with_last_axes_swapped(stored, shape[0], shape[1], shape[2]), motion);
    return motion;
}

void MotionsFile::check_limbs() const {
    if (tells_representation_ || representation_ != Representation::limb) return;
    if (const auto motion = read(names_[0]); !has_unit_limbs(motion))
        throw Error(
            "{}: '{}' holds no limb vectors, as their lengths are not 1; where they are joint positions, set "
            "the file's "
            "attribute representation to xyz, or make a dataset of them with actformer ingest motions",
            path_.string(), motion.name);
}

MotionDetails MotionsFile::details(const std::string& name) const {
    return read_details(file_->reader, name, path_.string());
}

struct MotionsWriter::Handle {
    hdf5::Writer writer;
};

MotionsWriter::MotionsWriter(const std::filesystem::path& path, Sync sync)
    : file_(new Handle{hdf5::Writer(path, sync)}) {}
MotionsWriter::~MotionsWriter() = default;

void MotionsWriter::add(const std::string& name, const Motion& motion, const MotionDetails& details) {
    const auto channels = motion.persons * motion.numbers;
    file_->writer.write<float>(
        name, {channels, motion.nodes, motion.frames},
        with_last_axes_swapped(channels_first(motion), channels, motion.frames, motion.nodes));
    if (details.label) file_->writer.attribute("label", std::int64_t{*details.label}, name);
    if (!details.bone_length.empty()) file_->writer.attribute("bone_length", details.bone_length, name);
}

void MotionsWriter::describe(const Subjects& subjects) {
    write_subjects(file_->writer, subjects);
}

void MotionsWriter::note(const std::string& attribute, const std::string& text) {
    file_->writer.attribute(attribute, text);
}

void MotionsWriter::finish() {
    file_->writer.finish();
}

}  // namespace actformer::ingest
