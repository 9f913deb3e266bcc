// libFuzzer: HDF5 files that are nearly GTA Combat's. Clips hold together, what is refused is one line. The library makes the files (see
// motions_fuzz.cpp).
#include <string>

#include "base/hdf5/file_memory.hpp"
#include "ingest/formats/gta/gta_format.hpp"
#include "tests/fuzz/fuzzing.hpp"
#include "tests/fuzz/nearly_hdf5.hpp"
#include "tests/fuzz/pickled_clips.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

/// One clip's place among the formats' datasets tells its persons.
class CheckedFights : public ingest::ClipSink {
  public:
    void take(ingest::ParsedClip clip) override {
        if (const auto* rejection = std::get_if<ingest::Rejection>(&clip))
            return demand_one_line(rejection->reason);
        const auto& made = *std::get<0>(clip);
        demand(!made.name.empty() && made.fields.size() == 1 &&
               made.dataset < ingest::GtaFormat::most_persons);
        for (const auto& doubt : made.doubts) demand_one_line(doubt);
    }
};

void make_fights(hid_t file, Choices& choose) {
    if (choose.below(8) == 1) add_nearly(file, {"avglength", H5T_IEEE_F32LE, {22}}, choose);
    add_nearly(file, {"fight", H5T_IEEE_F32LE, {6, 22, long_extent}}, choose);
    add_nearly(file, {"others", H5T_IEEE_F32LE, {3 * (1ULL + choose.below(18)), 22, 2}}, choose);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    hdf5::silence();
    static const Hdf5InMemory on_disk;
    static const ingest::GtaFormat format({});
    Choices choose(data, size);
    on_disk.write(made_file(make_fights, choose));
    const auto& path = on_disk.path();
    try_to([&] {
        CheckedFights sink;
        auto raw = file_of(path, {});
        raw.on_disk = true;
        format.read(raw, sink);
    });
    try_to([&] { ingest::GtaFormat({.lengths = path}); });
    return 0;
}
