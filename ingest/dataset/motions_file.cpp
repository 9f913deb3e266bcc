#include "ingest/dataset/motions_file.hpp"

#include <limits>

#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"

namespace actformer::ingest {

std::string public_name(const std::string& name, std::uint32_t label) {
    constexpr std::size_t digits = 3;
    const auto numbered = name.find_last_not_of("0123456789");
    if (numbered == std::string::npos || name[numbered] != 'A' || numbered + 1 + digits != name.size())
        return name;
    return fmt::format("{}{:03}", name.substr(0, numbered + 1), label + 1);
}

struct MotionsFile::Handle {
    hdf5::Reader reader;
};

MotionsFile::MotionsFile(const std::filesystem::path& path, Representation otherwise)
    : path_(path), file_(new Handle{hdf5::Reader(path)}), representation_(otherwise) {
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
    if (shape.size() != 3 || shape[0] == 0 || shape[0] % numbers != 0 || shape[1] == 0)
        throw Error("{}: '{}' is no (P*{}, K, T) array, as {} has them", path_.string(), name, numbers,
                    representation_.name());
    Motion motion{name,
                  static_cast<std::uint32_t>(shape[2]),
                  static_cast<std::uint32_t>(shape[0] / numbers),
                  static_cast<std::uint32_t>(shape[1]),
                  numbers,
                  {}};
    const auto stored = file_->reader.read<float>(name);
    motion.values.resize(stored.size());
    const float* from = stored.data();
    for (std::size_t p = 0; p < motion.persons; ++p)
        for (std::size_t d = 0; d < numbers; ++d)
            for (std::size_t k = 0; k < motion.nodes; ++k)
                for (std::size_t t = 0; t < motion.frames; ++t)
                    motion.values[((t * motion.persons + p) * motion.nodes + k) * numbers + d] = *from++;
    return motion;
}

MotionDetails MotionsFile::details(const std::string& name) const {
    MotionDetails details;
    if (file_->reader.has_attribute("label", name)) {
        const auto label = file_->reader.attribute_numbers("label", name);
        if (label.size() != 1 || label[0] < 0 || label[0] > std::numeric_limits<std::int32_t>::max())
            throw Error("{}: '{}' has a label that is no number from 0", path_.string(), name);
        details.label = static_cast<std::uint32_t>(label[0]);
    }
    if (file_->reader.has_attribute("bone_length", name))
        details.bone_length = file_->reader.attribute_floats("bone_length", name);
    return details;
}

struct MotionsWriter::Handle {
    explicit Handle(const std::filesystem::path& path) : aside(path), writer(aside.partial()) {}
    Aside aside;
    hdf5::Writer writer;
};

MotionsWriter::MotionsWriter(const std::filesystem::path& path) : file_(new Handle(path)) {}
MotionsWriter::~MotionsWriter() = default;

void MotionsWriter::add(const std::string& name, const Motion& motion, const MotionDetails& details) {
    std::vector<float> turned(motion.values.size());
    float* to = turned.data();
    for (std::size_t p = 0; p < motion.persons; ++p)
        for (std::size_t d = 0; d < motion.numbers; ++d)
            for (std::size_t k = 0; k < motion.nodes; ++k)
                for (std::size_t t = 0; t < motion.frames; ++t) *to++ = motion.at(t, p, k)[d];
    file_->writer.write<float>(name, {motion.persons * motion.numbers, motion.nodes, motion.frames}, turned);
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
    file_->aside.commit(file_->writer.finish());
}

}  // namespace actformer::ingest
