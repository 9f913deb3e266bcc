#include "kernels/device.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <optional>

#include "kernels/buffer.hpp"
#include "kernels/program_cache.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temp_dir.hpp"

using namespace actformer;
using kernels::DeviceInfo;

namespace {

std::vector<DeviceInfo> three_devices() {
    std::vector<DeviceInfo> devices(3);
    for (std::size_t i = 0; i < 3; ++i) devices[i].index = i;
    devices[0].name = "pthread-Some CPU";
    devices[0].type = "CPU";
    devices[0].memory = 64ULL << 30;
    devices[1].name = "Small GPU";
    devices[1].type = "GPU";
    devices[1].memory = 8ULL << 30;
    devices[2].name = "Large GPU";
    devices[2].type = "GPU";
    devices[2].memory = 80ULL << 30;
    return devices;
}

/// A variable of the environment, as it was before at the end.
class Variable {
  public:
    explicit Variable(const char* name) : name_(name) {
        if (const char* value = std::getenv(name)) before_ = value;
    }
    ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    void set(const std::string& value) const { setenv(name_, value.c_str(), 1); }

  private:
    const char* name_;
    std::optional<std::string> before_;
};

struct Choice : testing::Test {
    void SetUp() override { unsetenv("ACTFORMER_DEVICE"); }
    void TearDown() override { unsetenv("ACTFORMER_DEVICE"); }
};

}  // namespace

TEST_F(Choice, TakesTheLargestGpuByDefaultAndTheCpuWhereThereIsNoGpu) {
    auto devices = three_devices();
    EXPECT_EQ(choose_device(devices, ""), 2U);
    devices[2].shares_memory = true;
    EXPECT_EQ(choose_device(devices, ""), 1U) << "8 GiB of its own rather than 80 of the machine's";
    devices.resize(1);
    EXPECT_EQ(choose_device(devices, ""), 0U);
}

TEST_F(Choice, TakesANumberATypeOrPartOfAName) {
    const auto devices = three_devices();
    EXPECT_EQ(choose_device(devices, "1"), 1U);
    EXPECT_EQ(choose_device(devices, "cpu"), 0U);
    EXPECT_EQ(choose_device(devices, "GPU"), 1U);
    EXPECT_EQ(choose_device(devices, "large"), 2U);
}

TEST_F(Choice, FollowsTheEnvironmentUnlessTold) {
    const auto devices = three_devices();
    setenv("ACTFORMER_DEVICE", "small", 1);
    EXPECT_EQ(choose_device(devices, ""), 1U);
    EXPECT_EQ(choose_device(devices, "0"), 0U);
}

TEST_F(Choice, NamesWhatThereIsWhenNothingFits) {
    const auto devices = three_devices();
    for (const char* wish : {"3", "99999999999999999999", "-1", "radeon"}) try {
            choose_device(devices, wish);
            ADD_FAILURE() << wish;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("2 Large GPU"), std::string::npos) << e.what();
        }
    EXPECT_THROW(kernels::choose_device({}, ""), Error);
}

TEST_F(Choice, NamesPoclsCacheWhereItCannotBeWritten) {
    const test::TempDir dir;
    test::write_file(dir / "pocl/pocl.icd", "");
    test::write_file(dir / "others/other.icd", "");
    test::write_file(dir / "file", "");
    const auto at = [&](const std::string& name) { return (dir / name).string(); };
    const auto said = [] { return test::error_of([] { kernels::choose_device({}, ""); }); };
    const Variable drivers("OCL_ICD_VENDORS"), pocl("POCL_CACHE_DIR"), user("XDG_CACHE_HOME");
    drivers.set(at("pocl"));
    pocl.set(at("file/own"));
    EXPECT_EQ(said(), "no OpenCL device: PoCL cannot write its cache folder " + at("file/own") +
                          "; let POCL_CACHE_DIR name a folder that can be written");
    pocl.set("");
    user.set(at("file"));
    EXPECT_NE(said().find(at("file/pocl/kcache") + "; let POCL_CACHE_DIR"), std::string::npos) << said();
    drivers.set(at("others"));
    EXPECT_NE(said().find("install a driver"), std::string::npos) << said();
    drivers.set(at("pocl"));
    user.set(at("cache"));
    EXPECT_NE(said().find("install a driver"), std::string::npos) << said();
}

TEST(Device, RunsAKernelFromSourceOverAnyRange) {
    kernels::Device device;
    const char* source =
        "kernel void index(global uint* out, uint width, uint height) {"
        "  const uint x = get_global_id(0), y = get_global_id(1);"
        "  if (x < width && y < height) out[y * width + x] = y * 1000 + x; }";
    for (const auto& [width, height] : {std::pair(1U, 1U), {5U, 1U}, {1U, 777U}, {75U, 103U}, {1000U, 3U}}) {
        const kernels::Buffer<std::uint32_t> out(device, std::size_t{width} * height);
        launch(device, device.kernel_from(source, "index", "index"), {width, height}, out, width, height);
        const auto values = out.download();
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) ASSERT_EQ(values[y * width + x], y * 1000 + x);
    }
}

TEST(Device, ShowsTheBuildLogOfASourceThatDoesNotCompile) {
    kernels::Device device;
    try {
        device.kernel_from("kernel void broken(global float* x) { x[0] = no_such_thing; }", "broken.cl",
                           "broken");
        FAIL();
    } catch (const Error& e) {
        EXPECT_NE(std::string(e.what()).find("broken.cl"), std::string::npos);
        EXPECT_NE(std::string(e.what()).find("no_such_thing"), std::string::npos) << e.what();
    }
    EXPECT_THROW(device.kernel("no_such_file", "x"), Error);
    EXPECT_THROW(device.kernel("smooth", "no_such_kernel"), Error);
}

TEST(Device, SaysSoWhenABufferIsLargerThanTheDevice) {
    kernels::Device device;
    EXPECT_THROW(kernels::Buffer<float>(device, std::size_t{1} << 50), Error);
}

TEST(ProgramCache, BuildsOncePerSourceAndOptions) {
    const kernels::Device device;
    kernels::ProgramCache cache(device.context(), device.handle());
    const std::string source = "kernel void f(global int* x) { x[0] = N; }";
    const auto first = cache.get(source, "f.cl", "-DN=1");
    EXPECT_EQ(cache.get(source, "f.cl", "-DN=1")(), first());
    EXPECT_NE(cache.get(source, "f.cl", "-DN=2")(), first());
    EXPECT_NE(cache.get(source + " ", "f.cl", "-DN=1")(), first());
    EXPECT_EQ(cache.size(), 3U);
}

TEST(ProgramCache, PrintsNoWarnings) {
    const kernels::Device device;
    kernels::ProgramCache cache(device.context(), device.handle());
    // New text each time: PoCL keeps what it compiled before, and is silent then.
    const auto now = std::chrono::system_clock::now().time_since_epoch().count();
    const auto source =
        "#warning doubtful\nkernel void f(global long* x) { x[0] = " + std::to_string(now) + "; }";
    testing::internal::CaptureStderr();
    cache.get(source, "f.cl", "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}
