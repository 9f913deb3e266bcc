#include "ingest/dataset/motions_file.hpp"

#include "base/error.hpp"
#include "base/files/aside.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"

namespace actformer::ingest {

struct MotionsFile::Handle {
    hdf5::Reader reader;
};

MotionsFile::MotionsFile(const std::filesystem::path& path)
    : path_(path), file_(new Handle{hdf5::Reader(path)}) {
    for (auto& name : file_->reader.names())
        if (file_->reader.is_array(name)) names_.push_back(std::move(name));
    if (names_.empty())
        throw Error("{}: holds no motions; one (P*C, K, T) array a clip is expected", path.string());
    subjects_ = read_subjects(file_->reader, path.string());
}

MotionsFile::~MotionsFile() = default;

Motion MotionsFile::read(const std::string& name) const {
    const auto shape = file_->reader.shape(name);
    if (shape.size() != 3 || shape[0] == 0 || shape[0] % 3 != 0 || shape[1] == 0)
        throw Error("{}: '{}' is no (P*3, K, T) array", path_.string(), name);
    Motion motion;
    motion.name = name;
    motion.persons = static_cast<std::uint32_t>(shape[0] / 3);
    motion.joints = static_cast<std::uint32_t>(shape[1]);
    motion.frames = static_cast<std::uint32_t>(shape[2]);
    const auto stored = file_->reader.read<float>(name);
    motion.values.resize(stored.size());
    const float* from = stored.data();
    for (std::size_t p = 0; p < motion.persons; ++p)
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t k = 0; k < motion.joints; ++k)
                for (std::size_t t = 0; t < motion.frames; ++t)
                    motion.values[((t * motion.persons + p) * motion.joints + k) * 3 + d] = *from++;
    return motion;
}

struct MotionsWriter::Handle {
    explicit Handle(const std::filesystem::path& path) : aside(path), writer(aside.partial()) {}
    Aside aside;
    hdf5::Writer writer;
};

MotionsWriter::MotionsWriter(const std::filesystem::path& path) : file_(new Handle(path)) {}
MotionsWriter::~MotionsWriter() = default;

void MotionsWriter::add(const std::string& name, const Motion& motion) {
    std::vector<float> turned(motion.values.size());
    float* to = turned.data();
    for (std::size_t p = 0; p < motion.persons; ++p)
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t k = 0; k < motion.joints; ++k)
                for (std::size_t t = 0; t < motion.frames; ++t) *to++ = motion.at(t, p, k)[d];
    file_->writer.write<float>(name, {motion.persons * 3, motion.joints, motion.frames}, turned);
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
