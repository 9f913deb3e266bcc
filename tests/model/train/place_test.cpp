// What torchrun, mpirun and srun tell their processes, and what they leave out.
#include "model/train/place.hpp"

#include <gtest/gtest.h>

#include <map>

#include "base/error.hpp"

using namespace actformer;
using namespace actformer::model;

namespace {

using Set = std::map<std::string, std::string>;

Place place(const Set& set) {
    return place_of([&](const std::string& name) -> std::optional<std::string> {
        const auto found = set.find(name);
        if (found == set.end()) return std::nullopt;
        return found->second;
    });
}

std::string complaint(const Set& set) {
    try {
        place(set);
    } catch (const Error& e) {
        return e.what();
    }
    return "taken";
}

}  // namespace

TEST(Place, OfTorchrun) {
    const auto p = place({{"RANK", "5"},
                          {"WORLD_SIZE", "8"},
                          {"LOCAL_RANK", "1"},
                          {"LOCAL_WORLD_SIZE", "4"},
                          {"MASTER_ADDR", "node3"},
                          {"MASTER_PORT", "4711"},
                          {"TORCHELASTIC_USE_AGENT_STORE", "True"},
                          {"TORCHELASTIC_RESTART_COUNT", "2"},
                          {"SLURM_PROCID", "0"},
                          {"SLURM_NTASKS", "1"}});
    EXPECT_EQ(p.rank, 5);
    EXPECT_EQ(p.size, 8);
    EXPECT_EQ(p.local, 1);
    EXPECT_EQ(p.address, "node3");
    EXPECT_EQ(p.port, 4711);
    EXPECT_TRUE(p.store_runs);
    EXPECT_EQ(p.prefix, "actformer/2");
    EXPECT_FALSE(p.leads());
}

TEST(Place, OfMpirun) {
    const Set open{{"OMPI_COMM_WORLD_RANK", "0"},
                   {"OMPI_COMM_WORLD_SIZE", "2"},
                   {"OMPI_COMM_WORLD_LOCAL_RANK", "0"},
                   {"OMPI_COMM_WORLD_LOCAL_SIZE", "2"}};
    EXPECT_EQ(place(open).address, "127.0.0.1");
    EXPECT_EQ(place(open).port, 29500);
    EXPECT_TRUE(place(open).leads());
    EXPECT_FALSE(place(open).store_runs);
    auto wide = open;
    wide["OMPI_COMM_WORLD_LOCAL_SIZE"] = "1";
    EXPECT_NE(complaint(wide).find("MASTER_ADDR"), std::string::npos) << complaint(wide);
    wide["MASTER_ADDR"] = "head";
    EXPECT_EQ(place(wide).address, "head");
    EXPECT_EQ(place({{"PMI_RANK", "3"}, {"PMI_SIZE", "4"}, {"MASTER_ADDR", "head"}}).local, 3);
}

TEST(Place, OfSrun) {
    Set set{{"SLURM_PROCID", "9"},
            {"SLURM_NTASKS", "16"},
            {"SLURM_LOCALID", "1"},
            {"SLURM_NNODES", "4"},
            {"SLURM_JOB_ID", "123456"},
            {"SLURM_STEP_NODELIST", "gpu[07-09,12]"},
            {"SLURM_LAUNCH_NODE_IPADDR", "10.0.0.1"}};
    EXPECT_EQ(place(set).address, "gpu07");
    EXPECT_EQ(place(set).port, 20000 + 123456 % 20000);
    EXPECT_EQ(place(set).local, 1);
    set["SLURM_STEP_NODELIST"] = "alpha,beta[1-2]";
    EXPECT_EQ(place(set).address, "alpha");
    set.erase("SLURM_STEP_NODELIST");
    EXPECT_EQ(place(set).address, "10.0.0.1");
    set["SLURM_NNODES"] = "1";
    EXPECT_EQ(place(set).address, "127.0.0.1");
}

TEST(Place, OfSrunThatSpeaksPmi) {
    Set set{{"PMI_RANK", "9"},      {"PMI_SIZE", "16"},
            {"SLURM_PROCID", "9"},  {"SLURM_NTASKS", "16"},
            {"SLURM_LOCALID", "1"}, {"SLURM_NNODES", "4"},
            {"SLURM_JOB_ID", "7"},  {"SLURM_STEP_NODELIST", "gpu[07-10]"}};
    EXPECT_EQ(place(set).rank, 9);
    EXPECT_EQ(place(set).local, 1) << "the second GPU of its machine";
    EXPECT_EQ(place(set).address, "gpu07");
    set["SLURM_PROCID"] = "0";  // of a batch script whose processes another launcher started
    EXPECT_EQ(place(set).local, 9);
    set["MPI_LOCALRANKID"] = "3";
    EXPECT_EQ(place(set).local, 3);
}

TEST(Place, OfNobodyOrNonsense) {
    EXPECT_NE(complaint({}).find("torchrun --no_python --nproc_per_node 2 "), std::string::npos);
    EXPECT_NE(complaint({{"RANK", "0"}}).find("torchrun"), std::string::npos);
    for (const std::string bad : {"-1", "two", "", "99999999999999999999", "1 "})
        EXPECT_NE(complaint({{"RANK", bad}, {"WORLD_SIZE", "2"}}).find("RANK=" + bad), std::string::npos)
            << bad;
    EXPECT_NE(complaint({{"RANK", "2"}, {"WORLD_SIZE", "2"}}).find("WORLD_SIZE=2"), std::string::npos);
}
