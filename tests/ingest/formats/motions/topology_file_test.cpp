#include "ingest/formats/motions/topology_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.hpp"
#include "ingest/dataset/known_topologies.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using namespace actformer::ingest;
using namespace actformer::test;

TEST(TopologyFile, KnowsUsualSkeletons) {
    for (const auto& [name, topology] : known_topologies()) {
        EXPECT_EQ(topology_called(std::string(name)), topology);
        EXPECT_NO_THROW(topology.check("")) << name;
        EXPECT_TRUE(name.ends_with(std::to_string(topology.joints()))) << name;
    }
    EXPECT_EQ(topology_called("ntu25"), ntu25());
    // Symmetric: what is left of a joint called left is called right, below the other side's parent or the same.
    for (const auto& [name, t] : known_topologies()) {
        for (std::size_t j = 0; j < t.joints(); ++j) {
            if (!t.names[j].starts_with("left ")) continue;
            const auto other = std::find(t.names.begin(), t.names.end(), "right " + t.names[j].substr(5));
            ASSERT_NE(other, t.names.end()) << name << " " << t.names[j];
            auto parent = t.names[static_cast<std::size_t>(t.parents[j])];
            if (parent.starts_with("left ")) parent = "right " + parent.substr(5);
            EXPECT_EQ(t.names[static_cast<std::size_t>(
                          t.parents[static_cast<std::size_t>(other - t.names.begin())])],
                      parent)
                << name << " " << *other;
        }
    }
}

TEST(TopologyFile, ReadsJsonAndYaml) {
    const TempDir dir;
    const Topology wanted{{"hips", "knee", "foot"}, {-1, 0, 1}};
    for (const std::string text : {"{\"names\": [\"hips\", \"knee\", \"foot\"], \"parents\": [-1, 0, 1]}",
                                   "names: [hips, knee, foot]\nparents: [-1, 0, 1]\n",
                                   "names: [hips, knee, foot]\nparents: [~, hips, knee]\n"}) {
        write_file(dir / "skeleton", text);
        EXPECT_EQ(topology_called((dir / "skeleton").string()), wanted) << text;
    }
}

TEST(TopologyFile, NamesWhatIsWrong) {
    const TempDir dir;
    const auto fault = [&](const std::string& text) {
        write_file(dir / "skeleton", text);
        try {
            topology_called((dir / "skeleton").string());
            return std::string("taken");
        } catch (const Error& e) {
            return std::string(e.what()).substr((dir / "skeleton").string().size());
        }
    };
    EXPECT_EQ(fault("").substr(0, 33), ": a skeleton is told by names and");
    EXPECT_EQ(fault("names: [a, b]").substr(0, 33), ": a skeleton is told by names and");
    EXPECT_EQ(fault("parents: [-1]").substr(0, 33), ": a skeleton is told by names and");
    EXPECT_EQ(fault("names: hips").substr(0, 33), ": a skeleton is told by names and");
    EXPECT_EQ(fault("names: [a, b]\nparents: [-1]").substr(0, 30), ": 2 joint names for 1 parents;");
    EXPECT_EQ(fault("names: [a, b]\nparents: [-1, 2]").substr(0, 25), ": joint 1 (b) has parent ");
    EXPECT_EQ(fault("names: [a, a]\nparents: [-1, 0]"), ": two joints have the same name");
    EXPECT_EQ(fault("names: [a, b]\nparents: [-1, c]").substr(0, 9), ": line 2:");
    EXPECT_EQ(fault("names: [a, b").substr(0, 6), ": line");
    EXPECT_EQ(fault("names: [a, b]\nparents: [-1, 0]\nparents: [1, -1]"),
              ": line 3: 'parents' is given twice");
    try {
        topology_called("smpl25");
        FAIL() << "taken";
    } catch (const Error& e) {
        EXPECT_STREQ(
            e.what(),
            "no topology 'smpl25': neither a file nor one of ntu25, smpl24, coco17, h36m17, gta22, common15");
    }
}
