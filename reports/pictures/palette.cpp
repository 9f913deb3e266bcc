#include "reports/pictures/palette.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace actformer::reports {
namespace {

struct Counted {
    cv::Vec3b colour;
    double weight;
};

/// A part of the colours, with what is wrong with giving them one colour.
struct Box {
    std::vector<Counted> inside;
    cv::Vec3d mean{0, 0, 0};
    double spread = 0;  ///< summed squared distance along `channel`
    int channel = 0;

    explicit Box(std::vector<Counted> colours) : inside(std::move(colours)) {
        double weight = 0;
        cv::Vec3d squares{0, 0, 0};
        for (const auto& c : inside) {
            const cv::Vec3d v = c.colour;
            weight += c.weight;
            mean += c.weight * v;
            squares += c.weight * v.mul(v);
        }
        mean /= weight;
        for (int d = 0; d < 3; ++d)
            if (const double s = squares[d] - weight * mean[d] * mean[d]; s > spread) {
                spread = s;
                channel = d;
            }
    }

    bool splits() const { return inside.size() > 1 && spread > 1e-6; }
};

std::vector<Counted> count_colours(const std::vector<cv::Mat>& pictures) {
    std::unordered_map<std::uint32_t, std::size_t> counts;
    for (const auto& picture : pictures)
        for (int y = 0; y < picture.rows; ++y)
            for (int x = 0; x < picture.cols; ++x) {
                const auto& p = picture.at<cv::Vec3b>(y, x);
                ++counts[p[0] | p[1] << 8 | p[2] << 16];
            }
    std::vector<Counted> out;
    out.reserve(counts.size());
    for (const auto& [key, count] : counts)
        // Less than in proportion: floor and shadow have many pixels and few colours, limbs few pixels and
        // many colours.
        out.push_back({cv::Vec3b(key & 255, (key >> 8) & 255, (key >> 16) & 255),
                       std::pow(static_cast<double>(count), 0.7)});
    // Sorted, as the map's order differs between libraries: the same pictures give the same palette.
    std::ranges::sort(out, {},
                      [](const Counted& c) { return c.colour[0] | c.colour[1] << 8 | c.colour[2] << 16; });
    return out;
}

/// Cuts a box where its weight halves along its widest channel.
std::pair<Box, Box> cut(Box box) {
    std::ranges::stable_sort(box.inside, {}, [&](const Counted& c) { return c.colour[box.channel]; });
    const auto above = std::ranges::find_if(
        box.inside, [&](const Counted& c) { return c.colour[box.channel] > box.mean[box.channel]; });
    return {Box({box.inside.begin(), above}), Box({above, box.inside.end()})};
}

}  // namespace

std::vector<cv::Vec3b> median_cut(const std::vector<cv::Mat>& pictures, std::size_t most) {
    auto colours = count_colours(pictures);
    if (colours.empty()) return {};
    // The paper, which has most of the pixels, comes out as it is.
    const auto paper = std::ranges::max_element(colours, {}, &Counted::weight);
    std::vector<cv::Vec3b> out{paper->colour};
    colours.erase(paper);
    if (colours.empty()) return out;

    std::vector<Box> boxes;
    boxes.emplace_back(std::move(colours));
    while (boxes.size() + 1 < most) {
        const auto widest =
            std::ranges::max_element(boxes, {}, [](const Box& b) { return b.splits() ? b.spread : -1; });
        if (!widest->splits()) break;
        auto [low, high] = cut(std::move(*widest));
        *widest = std::move(low);
        boxes.push_back(std::move(high));
    }
    for (const auto& box : boxes) {
        cv::Vec3b mean;
        for (int d = 0; d < 3; ++d) mean[d] = cv::saturate_cast<std::uint8_t>(box.mean[d]);
        out.push_back(mean);
    }
    return out;
}

Palette::Palette(std::vector<cv::Vec3b> colours) : colours_(std::move(colours)), known_(1 << 21, -1) {}

std::uint8_t Palette::nearest(const cv::Vec3b& colour) {
    auto& known =
        known_[static_cast<std::size_t>((colour[0] >> 1) | (colour[1] >> 1) << 7 | (colour[2] >> 1) << 14)];
    if (known < 0) {
        int best = 1 << 30;
        for (std::size_t i = 0; i < colours_.size(); ++i) {
            const cv::Vec3i d = cv::Vec3i(colours_[i]) - cv::Vec3i(colour);
            // Eyes tell greens apart better than reds, and reds better than blues.
            const int distance = 2 * d[0] * d[0] + 4 * d[1] * d[1] + 3 * d[2] * d[2];
            if (distance < best) {
                best = distance;
                known = static_cast<std::int16_t>(i);
            }
        }
    }
    return static_cast<std::uint8_t>(known);
}

}  // namespace actformer::reports
