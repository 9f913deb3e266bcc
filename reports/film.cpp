#include "reports/film.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>
#include <vector>

#include "kernels/error.hpp"

namespace actformer::reports {

namespace fs = std::filesystem;

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

Aside::Aside(fs::path path) : path_(std::move(path)) {
    partial_ = path_;
    partial_.replace_extension(".partial" + path_.extension().string());
    std::error_code ignored;
    const auto folder = path_.has_parent_path() ? path_.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored))
        throw Error("cannot write {}: there is no folder {}; make it first", path_.string(), folder.string());
    if (fs::is_directory(path_, ignored))
        throw Error("cannot write {}: it is a folder; give a file name", path_.string());
    errno = 0;
    if (!std::ofstream(partial_, std::ios::binary))
        throw Error("cannot write {}: {}; choose another place with -o", path_.string(),
                    std::strerror(errno));
}

Aside::~Aside() {
    std::error_code ignored;
    if (!committed_) fs::remove(partial_, ignored);
}

void Aside::commit() {
    std::error_code failed;
    fs::rename(partial_, path_, failed);
    if (failed) throw Error("cannot give {} its name: {}", path_.string(), failed.message());
    committed_ = true;
}

}  // namespace actformer::reports
