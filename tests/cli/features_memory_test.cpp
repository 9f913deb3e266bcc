// `actformer features` on a device whose memory runs out: smaller batches, then one clear line. The device is a processor's
// and its memory the process's, limited by the shell (setrlimit) before the program starts.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <random>

#include "base/hdf5/reader.hpp"
#include "eval/stgcn/tuning.hpp"
#include "ingest/dataset/motions_file.hpp"
#include "kernels/device.hpp"
#include "tests/support/command.hpp"
#include "tests/support/plain_recogniser.hpp"
#include "tests/support/temp_dir.hpp"
#include "tests/support/unit_limbs.hpp"

using namespace actformer;
using namespace actformer::test;

namespace {

constexpr std::uint32_t motions = 400, frames = 60;

// All motions at once take some 2.1 GB on the device and half of them 1.05; the program alone takes up to 0.4 of these 1.9, with two threads of
// PoCL's however many cores there are.
const std::string limited = "ulimit -v 1900000; export POCL_MAX_PTHREAD_COUNT=2 MALLOC_ARENA_MAX=2; ";

/// Motions of few channels (padded to 64 a layer), and tiles that send all of them through the network together.
struct Memory : testing::Test {
    void SetUp() override {
        const kernels::Device device;
        if (device.info().type != "CPU") GTEST_SKIP() << "the limit is of the host's memory";
        kernels::Tiles tiles;  // of vectors of 16, whatever the processor has
        tiles.sequences = 65536;
        ::setenv("XDG_CACHE_HOME", dir.path().c_str(), 1);
        eval::save_tiles(device.info(), tiles);
        ::unsetenv("XDG_CACHE_HOME");
        write_stgcn_weights(dir / "w.h5", eval::random_stgcn_weights(3, 4, eval::ntu_graph(), 0.125, 5));
    }
    void write_motions(std::uint32_t count, std::uint32_t length) {
        ingest::MotionsWriter writer(dir / "m.h5");
        std::mt19937 random(1);
        std::normal_distribution<float> normal;
        ingest::Motion motion{"", length, 1, 25, 3, {}};
        motion.values.resize(std::size_t{length} * 25 * 3);
        for (std::uint32_t i = 0; i < count; ++i) {
            for (auto& v : motion.values) v = normal(random);
            make_unit_limbs(motion);
            writer.add("A001_" + std::to_string(i), motion);
        }
        writer.finish();
    }
    CommandResult features(const std::string& before, const std::string& out) const {
        return run_command(before + "XDG_CACHE_HOME=" + dir.path().string() +
                           " POCL_CACHE_DIR=" + (dir / "pocl").string() + " " + program() +
                           " features --batch 4096 --recogniser " + (dir / "w.h5").string() + " " +
                           (dir / "m.h5").string() + " -o " + (dir / out).string());
    }
    TempDir dir;
};

}  // namespace

TEST_F(Memory, ThatRunsOutMakesBatchesSmaller) {
    write_motions(motions, frames);
    const auto small = features(limited, "small.h5");
    ASSERT_EQ(small.exit, 0) << small.output;
    const auto whole = features("", "whole.h5");
    ASSERT_EQ(whole.exit, 0) << whole.output;
    const hdf5::Reader got(dir / "small.h5"), expected(dir / "whole.h5");
    EXPECT_EQ(got.read<float>("features"), expected.read<float>("features"));
    EXPECT_EQ(got.read<float>("logits"), expected.read<float>("logits"));
}

TEST_F(Memory, ThatHoldsNotOneMotionIsSaidSo) {
    write_motions(1, motions * frames);  // as much as all those above at once: it shows that they did not fit
    const auto result = features(limited, "f.h5");
    EXPECT_EQ(result.exit, 1) << result.output;
    EXPECT_EQ(lines_in(result.output), 1) << result.output;
    for (const auto* word : {"out of memory", "24000 frames", "--device"})
        EXPECT_NE(result.output.find(word), std::string::npos) << result.output;
    EXPECT_FALSE(std::filesystem::exists(dir / "f.h5"));
    EXPECT_FALSE(std::filesystem::exists(dir / "f.h5.partial"));
}
