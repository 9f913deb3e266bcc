// How long each layer takes, for whoever asks. Costs nothing while nobody does.
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace actformer::model {

/// Hears of every layer that ran on processors: its name, whether it ran backward, seconds.
using LayerListener = std::function<void(const std::string& layer, bool backward, double seconds)>;

/// One listener at a time; an empty one ends it. Not while layers run.
void listen_to_layers(LayerListener listener);
const LayerListener& layer_listener();

/// Times its own life.
class LayerTimer {
  public:
    explicit LayerTimer(const char* layer, bool backward = false)
        : layer_(layer), backward_(backward), listens_(static_cast<bool>(layer_listener())) {
        if (listens_) start_ = Clock::now();
    }
    ~LayerTimer() {
        if (listens_)
            layer_listener()(layer_, backward_, std::chrono::duration<double>(Clock::now() - start_).count());
    }
    LayerTimer(const LayerTimer&) = delete;
    LayerTimer& operator=(const LayerTimer&) = delete;

  private:
    using Clock = std::chrono::steady_clock;
    const char* layer_;
    bool backward_, listens_;
    Clock::time_point start_;
};

}  // namespace actformer::model
