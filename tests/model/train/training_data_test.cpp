// Which OpenCL device the processes of one machine draw their windows on.
#include "model/train/training_data.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "base/error.hpp"

using namespace actformer;
using namespace actformer::model;
using kernels::DeviceInfo;

namespace {

DeviceInfo device(std::size_t index, const std::string& type, const std::string& name,
                  const std::string& platform = "Some vendor's") {
    DeviceInfo info;
    info.index = index;
    info.type = type;
    info.name = name;
    info.platform = platform;
    info.memory = 80ULL << 30;
    info.shares_memory = type == "CPU";
    return info;
}

/// Two cards of one driver, a smaller one of it, the first once more by another driver, and a processor.
std::vector<DeviceInfo> machine() {
    std::vector<DeviceInfo> devices{device(0, "CPU", "pthread-Some CPU", "PoCL"), device(1, "GPU", "Fast A"),
                                    device(2, "GPU", "Fast B"), device(3, "GPU", "Slow"),
                                    device(4, "GPU", "Fast A, again", "Another's")};
    devices[3].memory = 8ULL << 30;
    return devices;
}

std::vector<std::size_t> drawn_on(const std::vector<DeviceInfo>& devices, const std::string& opencl,
                                  int processes) {
    std::vector<std::size_t> out;
    for (int local = 0; local < processes; ++local) out.push_back(device_of_process(devices, opencl, local));
    return out;
}

using Devices = std::vector<std::size_t>;

struct DeviceOfProcess : testing::Test {
    void SetUp() override { unsetenv("ACTFORMER_DEVICE"); }
    void TearDown() override { unsetenv("ACTFORMER_DEVICE"); }
};

}  // namespace

TEST_F(DeviceOfProcess, GpusOfTheChosenOnesDriverTakeTurns) {
    for (const char* wish : {"", "gpu", "GPU"})
        EXPECT_EQ(drawn_on(machine(), wish, 5), (Devices{1, 2, 3, 1, 2})) << wish;
    auto devices = machine();
    devices[2].memory *= 2;
    EXPECT_EQ(drawn_on(devices, "", 4), (Devices{2, 3, 1, 2})) << "the first process's is the default";
    devices[3].shares_memory = true;
    EXPECT_EQ(drawn_on(devices, "", 3), (Devices{2, 1, 2})) << "graphics of the processor are none of them";
}

TEST_F(DeviceOfProcess, OneDeviceIsForAll) {
    EXPECT_EQ(drawn_on({device(0, "GPU", "One")}, "", 3), (Devices{0, 0, 0}));
    EXPECT_EQ(drawn_on(machine(), "cpu", 3), (Devices{0, 0, 0}));
    EXPECT_EQ(drawn_on(machine(), "2", 3), (Devices{2, 2, 2})) << "named by its number";
}

TEST_F(DeviceOfProcess, ANameIsForThoseThatHaveIt) {
    EXPECT_EQ(drawn_on(machine(), "fast", 3), (Devices{1, 2, 1}));
    EXPECT_EQ(drawn_on(machine(), "slow", 2), (Devices{3, 3}));
    EXPECT_THROW(device_of_process(machine(), "radeon", 1), Error);
    EXPECT_THROW(device_of_process({}, "", 0), Error);
}

TEST_F(DeviceOfProcess, TheEnvironmentNamesOneWhereTheConfigurationDoesNot) {
    setenv("ACTFORMER_DEVICE", "fast b", 1);
    EXPECT_EQ(drawn_on(machine(), "", 2), (Devices{2, 2}));
    EXPECT_EQ(drawn_on(machine(), "gpu", 3), (Devices{1, 2, 3}));
    setenv("ACTFORMER_DEVICE", "3", 1);
    EXPECT_EQ(drawn_on(machine(), "", 2), (Devices{3, 3}));
}
