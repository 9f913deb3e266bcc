// How fast a method trains and generates on this machine. Knows nothing of torch.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace actformer::model {

struct MethodSpeedRequest {
    std::string method = "actformer";
    std::vector<std::string> overrides = {};                           ///< of its configuration, key=value
    std::uint32_t persons = 2, classes = 26, frames = 60, batch = 64;  ///< limbs of NTU's joints
    int threads = 0;                                                   ///< 0: as many as the process may use
    bool by_phase = false;  ///< a step is timed phase by phase, one of each kind; else whole
};

/// Milliseconds on processors.
struct LayerTime {
    std::string layer;
    double forward = 0, backward = 0;
};

/// The best of all rounds, wall and processors each by itself.
struct WorkTime {
    std::string name;                    ///< "step" or a phase's, as in "generator step"; "100 motions"
    double wall = 0;                     ///< seconds by the clock
    double processors = 0;               ///< seconds of processors, all threads together
    std::vector<LayerTime> layers = {};  ///< of wall's round, as they first ran; none on a GPU
};

class MethodSpeed {
  public:
    /// Sets the threads of libtorch. Throws Error for a method or a configuration that cannot be.
    explicit MethodSpeed(const MethodSpeedRequest& request);
    ~MethodSpeed();

    /// Runs a step of training, or each phase of one, and the generation of 100 motions `rounds` times more.
    void run(int rounds);

    const std::vector<WorkTime>& times() const;  ///< the step or its phases, then the generation

    /// What is timed: `frames` and `batch` are those of the configuration, overrides and all.
    const MethodSpeedRequest& request() const;
    const std::string& machine() const;  ///< libtorch, threads and products a second, in a line
    std::string device() const;          ///< of libtorch, where it trains and generates

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace actformer::model
