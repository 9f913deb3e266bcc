// How fast the networks train and generate on this machine. Knows nothing of torch.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace actformer::model {

struct SpeedRequest {
    std::uint32_t persons = 2, classes = 26, frames = 60, batch = 64;  ///< NTU's joints; else as in the paper
    int threads = 0;                                                   ///< 0: as many as the process may use
};

/// Milliseconds of one step.
struct LayerTime {
    std::string layer;
    double forward = 0, backward = 0;
};

struct StepTime {
    double seconds = 0;  ///< the best of all rounds
    std::vector<LayerTime>
        layers;  ///< of that round, in the order they first ran; what is left is the optimiser's and torch's
};

class SpeedTest {
  public:
    /// Sets the threads of libtorch.
    explicit SpeedTest(const SpeedRequest& request);
    ~SpeedTest();

    /// Runs each kind `rounds` times more. Where a kind got faster than it was, that is its time.
    void run(int rounds);

    const StepTime& discriminator_step() const;
    const StepTime& generator_step() const;
    const StepTime& generation() const;  ///< of 100 motions
    const std::string& machine() const;  ///< libtorch, threads and products a second, in a line

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace actformer::model
