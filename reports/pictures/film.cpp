#include "reports/pictures/film.hpp"

#include <algorithm>
#include <vector>

namespace actformer::reports {

void for_each_frame(const Film& film, const std::function<void(std::size_t, const cv::Mat&)>& use) {
    const auto at_once = static_cast<std::size_t>(std::clamp(cv::getNumThreads(), 1, 16));
    std::vector<cv::Mat> drawn(at_once);
    for (std::size_t first = 0; first < film.frames; first += at_once) {
        const auto count = std::min(at_once, film.frames - first);
        cv::parallel_for_(cv::Range(0, static_cast<int>(count)), [&](const cv::Range& range) {
            for (int i = range.start; i < range.end; ++i)
                drawn[i] = film.draw(first + static_cast<std::size_t>(i));
        });
        for (std::size_t i = 0; i < count; ++i) use(first + i, drawn[i]);
    }
}

}  // namespace actformer::reports
