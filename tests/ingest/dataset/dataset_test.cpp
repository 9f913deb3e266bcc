// Datasets in every representation: what dataset.json and the shards say comes back.
#include "ingest/dataset/dataset.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/hdf5/reader.hpp"
#include "ingest/dataset/view.hpp"
#include "tests/support/made_dataset.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;

namespace {

/// A copy of the arms in `how` with dataset.json changed.
std::string error_after(Representation how, const std::function<void(nlohmann::json&)>& change) {
    const TempDir dir;
    std::filesystem::copy(arms_in(how), dir / "data");
    auto json = nlohmann::json::parse(read_file(dir / "data/dataset.json"));
    change(json);
    json.erase("checksum");
    json.erase("program");
    write_file(dir / "data/dataset.json", json.dump());
    try {
        const Dataset dataset(dir / "data");
    } catch (const Error& e) {
        return std::string(e.what()).substr((dir / "data").string().size() + 1);
    }
    return "";
}

}  // namespace

TEST(Dataset, KeepsMotionsInEveryRepresentation) {
    for (const auto how : Representation::all()) {
        EXPECT_EQ(verify_dataset(arms_in(how)).faults, std::vector<std::string>{});
        const Dataset dataset(arms_in(how));
        EXPECT_EQ(dataset.header().representation, how);
        const auto clip = dataset.find("c2_5").value();
        const auto wanted = ArmsClip(2, 5, 40).in(how);
        const auto motion = dataset.motion(clip);
        EXPECT_EQ(motion.values, wanted.values);
        EXPECT_EQ(motion.nodes, wanted.nodes);
        EXPECT_EQ(motion.numbers, wanted.numbers);
        const auto shard = hdf5::Reader(arms_in(how) / "shard-00000.h5");
        EXPECT_EQ(shard.shape("motion"), (hdf5::Shape{48 * 40, 1, wanted.nodes, wanted.numbers}));
        EXPECT_EQ(shard.shape("clip/bone_length"), (hdf5::Shape{48, 1, ArmsClip::joints}));
        EXPECT_EQ(dataset.body(clip).rest.size(), how == Representation::rot6d ? ArmsClip::joints * 3 : 0U);
        EXPECT_EQ(joint_positions(motion, dataset.body(clip)).size(), 40 * ArmsClip::joints * 3);
    }
}

TEST(Dataset, WritesTheRestSkeletonLegibly) {
    const auto json = nlohmann::json::parse(read_file(arms_in(Representation::rot6d) / "dataset.json"));
    EXPECT_EQ(json.at("representation"), "rot6d");
    EXPECT_EQ(json.at("rest").dump(),
              "[[0.0,0.1,0.0],[0.3,0.0,0.0],[0.0,-0.3,0.0],[-0.3,0.0,0.0],[0.0,-0.3,0.0],[0.0,0.4,0.0],[0.0,"
              "0.2,0.1]]");
    EXPECT_FALSE(
        nlohmann::json::parse(read_file(arms_in(Representation::limb) / "dataset.json")).contains("rest"));
}

TEST(Dataset, RefusesRepresentationsThatContradictTheRest) {
    using Json = nlohmann::json;
    EXPECT_EQ(error_after(Representation::limb, [](Json& j) { j["representation"] = "quaternion"; }),
              "dataset.json: representation 'quaternion' is none of limb, rot6d, xyz");
    EXPECT_NE(error_after(Representation::limb, [](Json& j) { j["representation"] = "rot6d"; })
                  .find("'rest' has 0 offsets for 7 joints in representation rot6d"),
              std::string::npos);
    EXPECT_NE(
        error_after(Representation::rot6d, [](Json& j) { j["rest"].erase(3); }).find("'rest' has 6 offsets"),
        std::string::npos);
    EXPECT_NE(error_after(Representation::rot6d,
                          [](Json& j) {
                              j["rest"][3] = {1, 2};
                          })
                  .find("damaged"),
              std::string::npos);
    EXPECT_NE(error_after(Representation::rot6d,
                          [](Json& j) {
                              j["representation"] = "xyz";
                              j.erase("rest");
                          })
                  .find("'motion' is not (frames, 1, 7, 3)"),
              std::string::npos);
}

TEST(Dataset, CentresWindowsByTheNodeThatMovesTheBody) {
    kernels::Device device;
    for (const auto how : Representation::all()) {
        const auto view = load_view(device, Dataset(arms_in(how)), "s/test");
        kernels::Batch batch(view.store, 4, 20);
        kernels::WindowCutter(view.store, kernels::consecutive_windows(view.store.table().frames, 20))
            .cut(0, batch);
        const auto nodes = view.store.table().nodes, root = how.moving(nodes).root;
        const auto seen = batch.map();
        for (std::size_t d = 0; d < 3; ++d) {
            double mean = 0;
            for (std::size_t t = 0; t < 20; ++t) mean += seen.values[(d * 20 + t) * nodes + root] / 20.0;
            EXPECT_NEAR(mean, 0, 1e-6) << how.name();  // 20 float32 additions of numbers up to 1
        }
    }
}

TEST(Dataset, RefusesShardsThatAreNotBesideIt) {
    for (const std::string name :
         {"/etc/passwd", "../shard-00000.h5", "a/shard-00000.h5", "a/", "..", ".", ""})
        EXPECT_EQ(error_after(Representation::limb, [&](auto& j) { j["shards"][0]["file"] = name; }),
                  "dataset.json: shard '" + name + "' is no file's name; ingest the raw data again");
    EXPECT_EQ(error_after(Representation::limb, [](auto& j) { j["shards"].push_back(j["shards"][0]); }),
              "dataset.json: shard 'shard-00000.h5' is there twice; ingest the raw data again");
    EXPECT_TRUE(lies_below("one/shard-00000.h5")) << "as a journal has them";
    for (const auto* name : {"one/../../shard-00000.h5", "/one/shard-00000.h5", "one/", ""})
        EXPECT_FALSE(lies_below(name)) << name;
}

TEST(Dataset, RefusesFieldsThatAreThereTwiceAndTooMany) {
    const auto with = [](const std::vector<std::string>& fields) {
        return error_after(Representation::limb, [&](auto& j) { j["fields"] = fields; });
    };
    EXPECT_EQ(with({"part", "part"}), "dataset.json: field 'part' is there twice; ingest the raw data again");
    std::vector<std::string> many;
    for (std::size_t i = 0; i <= most_fields; ++i) many.push_back(fmt::format("f{}", i));
    EXPECT_EQ(with(many),
              "dataset.json: 1001 fields, and a clip has at most 1000; ingest the raw data again");
}
