// Moving pictures before they are a file, and files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>

namespace actformer::reports {

/// Frames that are drawn when they are asked for, from many threads at once.
struct Film {
    std::size_t frames = 0;
    double fps = 30;
    cv::Size size;
    std::function<cv::Mat(std::size_t)> draw;  ///< 8UC3, BGR, of `size`
};

/// Called with frames written and frames in all.
using Watcher = std::function<void(std::size_t, std::size_t)>;

/// Draws every frame, as many at once as there are processors, and hands them to `use` in order.
void for_each_frame(const Film& film, const std::function<void(std::size_t, const cv::Mat&)>& use);

/// A file in the making, beside where it will be: "out.partial.gif" for "out.gif". Gone at the end unless
/// commit() was called.
class Aside {
  public:
    /// Throws Error where nothing can be written at `path`.
    explicit Aside(std::filesystem::path path);
    ~Aside();
    Aside(const Aside&) = delete;
    Aside& operator=(const Aside&) = delete;

    const std::filesystem::path& partial() const { return partial_; }

    /// Gives the file its name; replaces what was there. Throws Error where that fails.
    void commit();

  private:
    std::filesystem::path path_, partial_;
    bool committed_ = false;
};

}  // namespace actformer::reports
