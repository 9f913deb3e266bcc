#include "ingest/formats/babel/sequence_files.hpp"

#include <gtest/gtest.h>

using namespace actformer::ingest;

namespace {

using Found = std::vector<std::size_t>;

}  // namespace

TEST(SequenceFiles, AreFoundUnderTheNamesOfAllYears) {
    SequenceFiles files;
    ASSERT_TRUE(files.add("BMLrub/BioMotionLab_NTroje/rub001/0005_treadmill_poses.npz"));
    ASSERT_TRUE(files.add("DFaust67/DFaust_67/50002/50002_jiggle_poses.npz"));
    ASSERT_TRUE(files.add("MPILimits/MPI_Limits/03099/op2_poses.npz"));
    ASSERT_TRUE(files.add("ACCAD/ACCAD/Female1Walking_c3d/D7 - walk to bow_poses.npz"));
    ASSERT_TRUE(files.add("KIT/KIT/3/walk_poses.npz"));
    ASSERT_TRUE(files.add("EKUT/EKUT/3/walk_poses.npz"));
    ASSERT_TRUE(files.add("Mine/v1.2/3/walk_poses.npz"));
    ASSERT_TRUE(files.add("Mine/v1/3/walk_poses.npz"));
    EXPECT_FALSE(files.add("walk_poses.npz"));
    const std::pair<const char*, Found> wanted[]{
        {"/data/amass/BioMotionLab_NTroje/rub001/0005_treadmill_poses.npz", {0}},
        {"amass/BMLrub/rub001/0005_treadmill_poses.npz", {0}},
        {"amass/bmlrub/rub001/0005_treadmill_stageii.npz", {0}},
        {"BMLrub.tar.bz2:BMLrub/rub001/0005_treadmill_poses.npz", {0}},
        {"BMLrub.tar.bz2:rub001/0005_treadmill_poses.npz", {0}},
        {"rub001/0005_treadmill_poses.npz", {0}},
        {"DFaust/50002/50002_jiggle_poses.npz", {1}},
        {"PosePrior/03099/op2_poses.npz", {2}},
        {"CMU/03099/op2_poses.npz", {}},
        {"ACCAD/Female1Walking_c3d/D7 - walk to bow_poses.npz", {3}},
        {"ACCAD/Female1Walking_c3d/D7_-_walk_to_bow_stageii.npz", {3}},
        {"amass/KIT/3/walk_poses.npz", {4}},
        {"amass/kit.tar.bz2:3/walk_poses.npz", {4}},
        {"cmu/EKUT/3/walk_poses.npz", {5}},
        {"raw/v1.2/3/walk_poses.npz", {6}},
        {"raw/v1/3/walk_poses.npz", {7}},
        {"raw/v1.tar/3/walk_poses.npz", {7}},
        {"3/walk_poses.npz", {4, 5, 6, 7}},
        {"KIT/3/run_poses.npz", {}},
        {"KIT/4/walk_poses.npz", {}},
        {"walk_poses.npz", {}}};
    for (const auto& [path, sequences] : wanted) EXPECT_EQ(files.of(path), sequences) << path;
    EXPECT_EQ(files.subset_of("cmu/BioMotionLab_NTroje/rub001/0005_treadmill_poses.npz"), "bmlrub");
    EXPECT_EQ(files.subset_of("raw/v1.tar:3/walk_poses.npz"), "v1");
    EXPECT_EQ(files.subset_of("other/KIT/walk_poses.npz"), "") << "there it is the subject";
}
