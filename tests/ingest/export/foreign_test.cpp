#include "ingest/export/foreign.hpp"

#include <gtest/gtest.h>

#include "base/hdf5/writer.hpp"
#include "ingest/export/export.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/made_dataset.hpp"
#include "tests/support/tree.hpp"

namespace actformer {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::TempDir;
using test::write_file;

struct Foreign : testing::Test {
    void SetUp() override {
        const test::ArmsClip clip(0, 0, 12);
        const ingest::Representation limb;
        ingest::DatasetHeader header;
        header.name = "arms";
        header.topology = test::ArmsClip::topology();
        header.classes = {"swing"};
        test::write_dataset(dir / "arms", header, {{{}, clip.in(limb), clip.bone_length()}});
    }
    ingest::ExportRequest to(const std::string& name, bool force = false) const {
        ingest::ExportRequest request;
        request.input = dir / "arms";
        request.out = dir / name;
        request.force = force;
        return request;
    }
    std::string says(const ingest::ExportRequest& request) const {
        return error_of([&] { ingest::export_clips(request); });
    }
    TempDir dir;
};

TEST_F(Foreign, FilesOfOthersAreKept) {
    for (const auto* name : {"a.h5", "a.npz", "a.glb", "a.bvh"}) {
        write_file(dir / name, "years of work");
        const auto said = says(to(name));
        EXPECT_NE(said.find(std::string(name) + ": is there, and "), std::string::npos) << said;
        EXPECT_NE(said.find("--force"), std::string::npos) << said;
        EXPECT_EQ(test::read_file(dir / name), "years of work");
        EXPECT_EQ(says(to(name, true)), "");
        EXPECT_NE(test::read_file(dir / name), "years of work");
    }
}

TEST_F(Foreign, WhatThisProgramWroteIsReplaced) {
    for (const auto* name : {"a.h5", "a.npz", "a.glb"}) {
        EXPECT_EQ(says(to(name)), "") << name;
        EXPECT_EQ(says(to(name)), "") << name << ", again";
    }
    write_file(dir / "empty.h5", "");
    EXPECT_EQ(says(to("empty.h5")), "") << "there is nothing to lose";
}

TEST_F(Foreign, AFolderIsCheckedBeforeAnythingIsWritten) {
    auto request = to("folder");
    request.format = "npz";
    write_file(dir / "folder/c0_0.npz", "mine");
    EXPECT_NE(says(request).find("c0_0.npz: is there"), std::string::npos) << says(request);
    EXPECT_EQ(test::read_file(dir / "folder/c0_0.npz"), "mine");
}

TEST_F(Foreign, InputsAreKept) {
    ASSERT_EQ(says(to("m.h5")), "");
    fs::create_symlink("m.h5", dir / "link.h5");
    const auto before = test::tree(dir.path());
    const auto kept = [&](const std::string& input, const std::string& out, bool force) {
        auto request = to(out, force);
        request.input = dir / input;
        EXPECT_EQ(says(request), (dir / out).string() + ": is an input of this export; choose another -o");
        EXPECT_EQ(test::tree(dir.path()), before) << input << " to " << out;
    };
    for (const bool force : {false, true}) {
        kept("m.h5", "m.h5", force);
        kept("m.h5", "link.h5", force);
        kept("link.h5", "m.h5", force);
    }
    kept("arms", "arms/shard-00000.h5", true);
}

TEST_F(Foreign, ADatasetsFolderTakesNoMotions) {
    const auto before = test::tree(dir.path());
    for (const bool force : {false, true}) {
        auto request = to("arms", force);
        request.format = "npz";
        EXPECT_EQ(says(request),
                  (dir / "arms").string() + ": holds a dataset, not exported motions; choose another -o");
    }
    EXPECT_EQ(test::tree(dir.path()), before);
}

TEST_F(Foreign, ShardsWeightsAndOtherMotionsAreKept) {
    const auto kept = [&](const std::string& name) {
        const auto bytes = test::read_file(dir / name);
        const auto said = says(to(name));
        EXPECT_NE(said.find(name + ": is there, and holds no motions that this program wrote"),
                  std::string::npos)
            << name << ": " << said;
        EXPECT_TRUE(test::read_file(dir / name) == bytes) << name;
    };
    kept("arms/shard-00000.h5");
    const auto motions = [&](const fs::path& path, const char* program, const char* kind) {
        hdf5::Writer file(path);
        const std::vector<float> values(36);
        file.write<float>("A001_0", {3, 3, 4}, values);
        file.attribute("representation", "limb");
        file.attribute("program", program);
        if (*kind) file.attribute("kind", kind);
        file.finish();
    };
    motions(dir / "python.h5", "actformer, the Python package", "");
    kept("python.h5");  // a method of the user's
    motions(dir / "weights.h5", "actformer 0.1.0", "stgcn");
    kept("weights.h5");
    motions(dir / "motions.h5", "actformer 0.1.0", "");
    EXPECT_EQ(says(to("motions.h5")), "");
}

}  // namespace
}  // namespace actformer
