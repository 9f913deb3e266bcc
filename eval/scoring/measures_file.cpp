#include "eval/scoring/measures_file.hpp"

#include "base/error.hpp"
#include "base/files/file.hpp"
#include "base/hdf5/reader.hpp"
#include "base/hdf5/writer.hpp"

namespace actformer::eval {

void write_measures(const std::filesystem::path& path, const MotionMeasures& measures) {
    hdf5::Writer file(measures.size() * (measures.columns + 4) * sizeof(float) + 65536);
    const hsize_t n = measures.size();
    const auto write = [&](const char* name, const std::vector<float>& values) {
        if (!values.empty()) file.write<float>(name, {n, values.size() / n}, values);
    };
    write("limb_acceleration", measures.limb_acceleration);
    write("root_acceleration", measures.root_acceleration);
    write("root_speed", measures.root_speed);
    write("foot_sliding", measures.foot_sliding);
    write("distances", measures.distances);
    write_whole(path, file.checked_image());
}

MotionMeasures read_measures(const std::filesystem::path& path) {
    const hdf5::Reader file(path);
    const auto read = [&](const char* name) {
        return file.has(name) ? file.read<float>(name) : std::vector<float>();
    };
    MotionMeasures out{read("limb_acceleration"), read("root_acceleration"), read("root_speed"),
                       read("foot_sliding"),      read("distances"),         0};
    const auto n = out.size();
    const auto none_or_all = [n](const auto& values) { return values.empty() || values.size() == n; };
    if (out.root_acceleration.size() != n || !none_or_all(out.root_speed) || !none_or_all(out.foot_sliding) ||
        (n == 0 ? !out.distances.empty() : out.distances.size() % n != 0))
        throw Error("{}: its arrays are not of the same motions; remove it", path.string());
    if (n > 0) out.columns = out.distances.size() / n;
    return out;
}

}  // namespace actformer::eval
