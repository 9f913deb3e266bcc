// SMPL's body on an OpenCL device beside the same in NumPy (skinning.py), in one run: bench_skinning [FRAMES [PYTHON]]. The model is
// random and of SMPL's sizes: 6,890 vertices, 24 joints, 10 shapes.
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <map>

#include "base/error.hpp"
#include "base/files/mapped_file.hpp"
#include "base/files/scratch.hpp"
#include "base/numpy/npz.hpp"
#include "base/process/peer.hpp"
#include "base/process/process.hpp"
#include "ingest/export/npz/npz_writer.hpp"
#include "ingest/smpl/body_file.hpp"
#include "kernels/peak.hpp"
#include "tests/support/paths.hpp"

using namespace actformer;

namespace {

using Clock = std::chrono::steady_clock;

std::map<std::string, std::vector<float>> floats_of(const std::filesystem::path& npz) {
    const MappedFile file(npz);
    std::map<std::string, std::vector<float>> out;
    read_npz(file.text(), {}, [&](const std::string& name, const NumpyArray& array) {
        const auto numbers = array.all_numbers();
        out[name].assign(numbers.begin(), numbers.end());
    });
    return out;
}

std::string ask(const std::vector<std::string>& command) {
    const auto said = output_of(command, {{"OMP_NUM_THREADS", "2"}, {"OPENBLAS_NUM_THREADS", "2"}});
    if (!said) throw Error("{}: failed; it needs python3-numpy", command_line(command));
    return *said;
}

void run(const std::string& frames_text, const std::string& python) {
    const Scratch folder("skinning");
    const auto peer = [&](const std::string& what, const std::string& more = "") {
        std::vector<std::string> command{python, test::source("tests/bench/skinning.py"), what,
                                         folder.path().string()};
        if (!more.empty()) command.push_back(more);
        return ask(command);
    };
    peer("make", frames_text);
    const auto start = Clock::now();
    const auto body = ingest::read_smpl_body(folder.path() / "model.npz");
    const auto read = std::chrono::duration<double>(Clock::now() - start).count();
    const auto poses = floats_of(folder.path() / "poses.npz");
    const auto& rotations = poses.at("rotations");
    const auto& translation = poses.at("translation");

    kernels::Device device;
    kernels::Skinning skinning(device, body.skin);
    skinning.shape(poses.at("betas"));
    double best = 1e30, peak = 0;
    std::map<std::string, double> numpy;
    for (int turn = 0; turn < 3;
         ++turn) {  // turns: a busy machine disturbs both alike, and each keeps its best
        for (int i = 0; i < 10; ++i) {
            const auto begin = Clock::now();
            skinning.pose(rotations, translation);
            device.queue().finish();
            best = std::min(best, std::chrono::duration<double>(Clock::now() - begin).count());
        }
        peak = std::max(peak, kernels::measure_peak(device, 16, 3));
        for (const char* kind : {"float64", "float32"})
            numpy[kind] = std::max(numpy[kind], std::stod(peer("time", kind)));
    }
    const auto frames = static_cast<double>(skinning.frames());
    const double blend = 6890 * 3 * 207 * 2.0, skin = 6890 * (4 * 12 + 9) * 2.0;  // operations a frame
    fmt::print("{}: {:.0f} frames a second of {} vertices; the model read in {:.2f} s\n", device.info().name,
               frames / best, body.skin.vertices(), read);
    fmt::print("{:.0f} GFLOP/s, {:.0f} % of {:.0f} that multiply-adds alone reach\n",
               frames / best * (blend + skin) * 1e-9, 100 * frames / best * (blend + skin) / peak,
               peak * 1e-9);
    for (const auto& [kind, rate] : numpy)
        fmt::print("NumPy, {}, two threads: {:.0f}, ratio {:.1f}\n", kind, rate, frames / best / rate);

    ingest::NpzWriter file(folder.path() / "posed.npz");
    file.add("joints", {skinning.frames(), 24, 3}, skinning.joints().download());
    file.add("vertices", {skinning.frames(), body.skin.vertices(), 3}, skinning.vertices().download());
    file.finish();
    fmt::print("furthest from the formulas in double: {} m\n", std::stod(peer("check")));
}

}  // namespace

int main(int count, char** arguments) try {
    run(count > 1 ? arguments[1] : "512", count > 2 ? arguments[2] : "/usr/bin/python3");
} catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
}
