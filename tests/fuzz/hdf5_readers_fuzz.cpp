// libFuzzer: HDF5 files that are nearly a shard, motions, a recogniser's weights or features, given to the readers of these. Each array
// and attribute is as it should be, another, elsewhere, or missing, and extents may be far beyond the file; the library makes it
// (see motions_fuzz.cpp).
#include <cstring>
#include <string>

#include "base/hdf5/file_memory.hpp"
#include "base/hdf5/reader.hpp"
#include "eval/gru/weights.hpp"
#include "eval/scoring/features_file.hpp"
#include "eval/stgcn/weights.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "ingest/dataset/shard.hpp"
#include "tests/fuzz/any_hdf5.hpp"
#include "tests/fuzz/file_in_memory.hpp"
#include "tests/fuzz/fuzzing.hpp"

using namespace actformer;
using namespace actformer::fuzzing;

namespace {

/// A number that stands nowhere else in such files.
constexpr std::uint64_t long_extent = 251;

struct Named {
    const char* name;
    hid_t type;
    hdf5::Shape shape;
};

/// Bytes that the fuzzer chooses, small numbers for the most part, and zeros behind the first few.
std::vector<char> chosen_values(hid_t type, std::size_t count, Choices& choose) {
    const auto size = H5Tget_size(type);
    std::vector<char> values(count * size);
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 8); ++i) {
        const auto how = choose.below(8);
        for (std::size_t b = 0; b < size; ++b)
            if (how == 7 || b == 0)
                values[i * size + b] = static_cast<char>(choose.below(how == 7 ? 256 : 4));
    }
    return values;
}

std::size_t numbers_in(const hdf5::Shape& shape) {
    std::size_t count = 1;
    for (const auto extent : shape) count *= extent;
    return count;
}

/// An array whose numbers lie elsewhere, or a link.
void add_away(hid_t file, const Named& wanted, Choices& choose) {
    const auto how = choose.below(3);
    if (how == 0) {
        H5Lcreate_soft(choose.below(2) ? "/soft" : wanted.name, file, wanted.name, H5P_DEFAULT, H5P_DEFAULT);
        return;
    }
    const auto space = space_of(wanted.shape);
    const Handle plan(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    if (how == 1)
        H5Pset_external(plan.get(), "/proc/self/status", 0, H5F_UNLIMITED);
    else
        H5Pset_virtual(plan.get(), space.get(), ".", wanted.name, space.get());
    const Handle set(
        H5Dcreate2(file, wanted.name, wanted.type, space.get(), H5P_DEFAULT, plan.get(), H5P_DEFAULT),
        H5Dclose);
}

/// Wherever the file says `long_extent`, another number.
void lengthen(std::vector<char>& image, Choices& choose) {
    constexpr std::uint64_t to[] = {std::uint64_t{1} << 62, 6148914691236517206, std::uint64_t{1} << 40,
                                    ~std::uint64_t{0} - 1,  long_extent + 1,     0};
    const auto other = to[choose.below(std::size(to))];
    for (std::size_t at = 0; at + 8 <= image.size(); ++at)
        if (std::memcmp(&image[at], &long_extent, 8) == 0) std::memcpy(&image[at], &other, 8);
}

/// The array as it should be but for its values, one that is elsewhere, any array, or none.
void add_nearly(hid_t file, const Named& wanted, Choices& choose) {
    const auto how = choose.below(8);
    if (how == 7) return;
    if (how == 6) return add_array(file, wanted.name, choose);
    if (how == 5) return add_away(file, wanted, choose);
    const auto space = space_of(wanted.shape);
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.get(), 1);
    const Handle set(
        H5Dcreate2(file, wanted.name, wanted.type, space.get(), links.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    if (set)
        H5Dwrite(set.get(), wanted.type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                 chosen_values(wanted.type, numbers_in(wanted.shape), choose).data());
}

void add_attribute_nearly(hid_t object, const Named& wanted, Choices& choose) {
    const auto how = choose.below(8);
    if (how == 7) return;
    if (how == 6) return add_attribute(object, wanted.name, choose);
    const auto space = space_of(wanted.shape);
    const Handle attribute(
        H5Acreate2(object, wanted.name, wanted.type, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    if (attribute)
        H5Awrite(attribute.get(), wanted.type,
                 chosen_values(wanted.type, numbers_in(wanted.shape), choose).data());
}

Handle text_type(std::size_t size) {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type.get(), size);
    return type;
}

void add_text(hid_t file, const char* name, const std::string& text) {
    const auto type = text_type(text.size());
    const auto space = space_of({});
    const Handle attribute(H5Acreate2(file, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    H5Awrite(attribute.get(), type.get(), text.data());
}

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

/// The first tensors of a network whose sizes they tell.
void make_weights(hid_t file, Choices& choose) {
    const auto text = text_type(3);
    for (const auto& wanted : std::vector<Named>{{"channels", H5T_STD_I64LE, {}},
                                                 {"classes", H5T_STD_I64LE, {}},
                                                 {"parents", H5T_STD_I64LE, {2}},
                                                 {"center", H5T_STD_I64LE, {}},
                                                 {"class_names", text.get(), {2}}})
        add_attribute_nearly(file, wanted, choose);
    for (const auto& wanted : std::vector<Named>{{"recurrent.weight_hh_l0", H5T_IEEE_F32LE, {48, 16}},
                                                 {"linear1.weight", H5T_IEEE_F32LE, {2, 16}},
                                                 {"fcn.weight", H5T_IEEE_F32LE, {2, 16, 1, 1}}})
        add_nearly(file, wanted, choose);
    for (std::size_t layer = 0; layer < eval::stgcn_layers; ++layer)
        add_nearly(
            file,
            {fmt::format("{}tcn.2.weight", eval::layer_prefix(layer)).c_str(), H5T_IEEE_F32LE, {2, 2, 9, 1}},
            choose);
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
    static const FileInMemory on_disk;
    Choices choose(data, size);
    const auto kind = choose.below(4);
    {
        const auto file = new_file();
        constexpr void (*make[])(hid_t, Choices&) = {make_shard, make_motions, make_features, make_weights};
        make[kind](file.get(), choose);
        auto image = image_of(file);
        if (choose.below(4) == 1) lengthen(image, choose);
        on_disk.write({image.data(), image.size()});
    }
    const auto& path = on_disk.path();
    if (kind == 0)
        try_to([&] {
            for (const auto& clip : ingest::read_clips(path, header(), 0))
                demand(clip.offset + clip.frames <= long_extent + 1 && clip.label < 3);
        });
    if (kind == 1) try_to([&] { read_motions(path); });
    if (kind == 2) try_to([&] { demand(eval::read_features(path).samples.size() < 36); });
    if (kind == 3) {
        try_to([&] { eval::read_stgcn_weights(path); });
        try_to([&] { eval::read_gru_weights(path); });
    }
    return 0;
}
