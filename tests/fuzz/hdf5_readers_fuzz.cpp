// libFuzzer: HDF5 files that are nearly a shard, motions or features, given to the readers of these. The library makes
// them (see motions_fuzz.cpp).
#include <string>

#include "base/hdf5/file_memory.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/scoring/features_file.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "ingest/dataset/shard.hpp"
#include "tests/fuzz/fuzzing.hpp"
#include "tests/fuzz/nearly_hdf5.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

/// Two joints, one person.
ingest::DatasetHeader header() {
    ingest::DatasetHeader header;
    header.topology = {{"a", "b"}, {-1, 0}};
    header.classes = {"c0", "c1", "c2"};
    header.fields = {"performer"};
    return header;
}

void make_shard(hid_t file, Choices& choose) {
    const auto text = text_type(3);
    for (const auto& wanted : std::vector<Named>{{"motion", H5T_IEEE_F32LE, {long_extent, 1, 2, 3}},
                                                 {"clip/offset", H5T_STD_U64LE, {2}},
                                                 {"clip/length", H5T_STD_U32LE, {2}},
                                                 {"clip/label", H5T_STD_U32LE, {2}},
                                                 {"clip/name", text.get(), {2}},
                                                 {"clip/performer", text.get(), {2}},
                                                 {"clip/bone_length", H5T_IEEE_F32LE, {2, 1, 2}}})
        add_nearly(file, wanted, choose);
}

void add_subjects(hid_t file, Choices& choose) {
    const auto text = text_type(3);
    static constexpr const char* known[] = {"limb", "rot6d", "xyz", "none"};
    if (choose.below(4) != 0) add_text(file, "representation", known[choose.below(4)]);
    for (const auto& wanted : std::vector<Named>{{"parents", H5T_STD_I64LE, {2}},
                                                 {"names", text.get(), {2}},
                                                 {"persons", H5T_STD_I64LE, {}},
                                                 {"bone_length", H5T_IEEE_F32LE, {2}},
                                                 {"rest", H5T_IEEE_F32LE, {6}},
                                                 {"classes", text.get(), {3}},
                                                 {"fps", H5T_IEEE_F32LE, {1}}})
        add_attribute_nearly(file, wanted, choose);
}

void make_motions(hid_t file, Choices& choose) {
    add_subjects(file, choose);
    for (const auto* name : {"A001_0", "A002_0"}) {
        add_nearly(file, {name, H5T_IEEE_F32LE, {3, 2, long_extent}}, choose);
        const Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
        if (!set) continue;
        add_attribute_nearly(set.get(), {"label", H5T_STD_I64LE, {}}, choose);
        add_attribute_nearly(set.get(), {"bone_length", H5T_IEEE_F32LE, {2}}, choose);
    }
}

void make_features(hid_t file, Choices& choose) {
    const auto text = text_type(3);
    for (const auto& wanted : std::vector<Named>{{"features", H5T_IEEE_F32LE, {3, 2}},
                                                 {"logits", H5T_IEEE_F32LE, {3, 2}},
                                                 {"labels", H5T_STD_U32LE, {3}},
                                                 {"names", text.get(), {3}}})
        add_nearly(file, wanted, choose);
    add_attribute_nearly(file, {"frames", H5T_STD_I64LE, {2}}, choose);
}

void read_motions(const std::string& path) {
    const ingest::MotionsFile file(path);
    try_to([&] { file.check_limbs(); });
    for (const auto& name : file.names()) {
        try_to([&] { file.details(name); });
        const auto motion = file.read(name);
        demand(motion.values.size() ==
               std::size_t{motion.frames} * motion.persons * motion.nodes * motion.numbers);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    hdf5::silence();
    static const Hdf5InMemory on_disk;
    Choices choose(data, size);
    const auto kind = choose.below(3);
    constexpr void (*make[])(hid_t, Choices&) = {make_shard, make_motions, make_features};
    on_disk.write(made_file(make[kind], choose));
    const auto& path = on_disk.path();
    if (kind == 0)
        try_to([&] {
            for (const auto& clip : ingest::read_clips(path, header(), 0))
                demand(clip.offset + clip.frames <= long_extent + 1 && clip.label < 3);
        });
    if (kind == 1) try_to([&] { read_motions(path); });
    if (kind == 2) try_to([&] { demand(eval::read_features(path).samples.size() < 36); });
    return 0;
}
