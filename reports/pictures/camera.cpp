#include "reports/pictures/camera.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/error.hpp"
#include "base/text/lower_case.hpp"

namespace actformer::reports {
namespace {

constexpr std::pair<const char*, View> named_views[] = {
    {"front", {0, 8, false}}, {"side", {90, 8, false}}, {"back", {180, 8, false}},
    {"top", {0, 90, false}},  {"orbit", {0, 14, true}}, {"three-quarter", {}},
};

const cv::Vec3d vertical{0, 1, 0};

cv::Vec3d point(const JointMotion& motion, std::size_t frame, std::size_t person, std::size_t joint) {
    const float* x = motion.at(frame, person, joint);
    return {x[0], x[1], x[2]};
}

cv::Vec3d flat(const cv::Vec3d& v) {
    return {v[0], 0, v[2]};
}

/// Calls `use(frame, person)` for every visible body.
template <typename Use>
void for_bodies(const JointMotion& motion, Use use) {
    for (std::size_t t = 0; t < motion.frames; ++t)
        for (std::size_t p = 0; p < motion.persons; ++p)
            if (motion.visible(t, p)) use(t, p);
}

/// Pairs of joints whose names differ in the side alone.
std::vector<std::pair<std::size_t, std::size_t>> left_right_pairs(const ingest::Topology& topology) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    const auto stem = [](std::string name) {
        name = lower_case(name);
        for (const char* side : {"left", "right"})
            if (const auto at = name.find(side); at != std::string::npos)
                return name.erase(at, std::string(side).size());
        const bool at_end = name.size() > 1 && (name.back() == 'l' || name.back() == 'r') &&
                            !std::isalpha(static_cast<unsigned char>(name[name.size() - 2]));
        return at_end ? name.substr(0, name.size() - 1) : name.substr(1);
    };
    for (std::size_t l = 0; l < topology.joints(); ++l)
        for (std::size_t r = 0; r < topology.joints(); ++r)
            if (side_of(topology.names[l]) == Side::left && side_of(topology.names[r]) == Side::right &&
                stem(topology.names[l]) == stem(topology.names[r]))
                pairs.emplace_back(l, r);
    return pairs;
}

/// The horizontal direction that a body faces, from its left and right joints; zero where it cannot be told.
cv::Vec3d faces(const JointMotion& motion, std::size_t frame, std::size_t person,
                const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
    cv::Vec3d to_right{0, 0, 0};
    for (const auto& [l, r] : pairs) {
        // Joints near the root (hips, shoulders) tell more than hands: weigh by 1 / (1 + depth)^2.
        double depth = 1;
        for (int j = motion.topology.parents[l]; j >= 0; j = motion.topology.parents[j]) ++depth;
        to_right += (point(motion, frame, person, r) - point(motion, frame, person, l)) / (depth * depth);
    }
    const cv::Vec3d ahead = vertical.cross(flat(to_right));
    const double length = cv::norm(ahead);
    return length > 1e-9 ? ahead / length : cv::Vec3d{0, 0, 0};
}

/// Root positions seen, as the direction in which they differ most between persons; zero for one person.
cv::Vec3d line_of_persons(const JointMotion& motion) {
    std::vector<cv::Vec3d> sums(motion.persons, {0, 0, 0});
    std::vector<double> counts(motion.persons, 0);
    for_bodies(motion, [&](std::size_t t, std::size_t p) {
        sums[p] += flat(point(motion, t, p, 0));
        ++counts[p];
    });
    cv::Vec3d best{0, 0, 0};
    for (std::size_t a = 0; a < motion.persons; ++a)
        for (std::size_t b = a + 1; b < motion.persons; ++b)
            if (counts[a] > 0 && counts[b] > 0)
                if (const cv::Vec3d d = sums[a] / counts[a] - sums[b] / counts[b];
                    cv::norm(d) > cv::norm(best))
                    best = d;
    return best;
}

/// Where azimuth 0 looks from: the persons' faces; two who face each other are seen from the side, so that
/// neither hides the other.
cv::Vec3d front_of(const JointMotion& motion) {
    const auto pairs = left_right_pairs(motion.topology);
    cv::Vec3d sum{0, 0, 0};
    double bodies = 0;
    for_bodies(motion, [&](std::size_t t, std::size_t p) {
        sum += faces(motion, t, p, pairs);
        ++bodies;
    });
    const bool agree = cv::norm(sum) > 0.5 * bodies;
    if (const auto line = line_of_persons(motion); !agree && cv::norm(line) > 1e-3) {
        const auto across = vertical.cross(line) / cv::norm(line);
        return across.dot(sum) < 0 ? -across : across;
    }
    if (cv::norm(sum) > 1e-6) return sum / cv::norm(sum);
    return {0, 0, 1};
}

double percentile(std::vector<double>& values, double fraction) {
    const auto nth = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), values.begin() + nth, values.end());
    return values[static_cast<std::size_t>(nth)];
}

/// The whole range of `values`, but no more than 0.75 of the range of 98 % of them beyond those: real
/// movements stay whole, a joint that is lost for a frame does not count.
std::pair<double, double> robust_range(std::vector<double> values) {
    const double low = percentile(values, 0.01), high = percentile(values, 0.99);
    const auto [least, most] = std::ranges::minmax(values);
    const double beyond = 0.75 * (high - low);
    return {std::max(least, low - beyond), std::min(most, high + beyond)};
}

/// The middle of the visible roots in each frame, at height 0, smoothed over about a second; held where
/// nobody is seen.
std::vector<cv::Vec3d> path_of_group(const JointMotion& motion) {
    std::vector<cv::Vec3d> middle(motion.frames, {0, 0, 0});
    std::vector<bool> known(motion.frames, false);
    for (std::size_t t = 0; t < motion.frames; ++t) {
        double bodies = 0;
        for (std::size_t p = 0; p < motion.persons; ++p)
            if (motion.visible(t, p)) {
                middle[t] += flat(point(motion, t, p, 0));
                ++bodies;
            }
        known[t] = bodies > 0;
        if (known[t]) middle[t] /= bodies;
        if (!known[t] && t > 0 && known[t - 1]) {
            middle[t] = middle[t - 1];
            known[t] = true;
        }
    }
    const auto first = static_cast<std::size_t>(std::ranges::find(known, true) - known.begin());
    std::fill_n(middle.begin(), first, middle[first]);

    const auto sigma = std::min(0.4 * motion.fps, 200.0);
    const auto radius = static_cast<std::ptrdiff_t>(2.5 * sigma);
    std::vector<cv::Vec3d> smooth(motion.frames);
    for (std::ptrdiff_t t = 0; t < std::ssize(middle); ++t) {
        cv::Vec3d sum{0, 0, 0};
        double weight = 0;
        for (auto s = t - radius; s <= t + radius; ++s) {
            const double distance = static_cast<double>(s - t) / sigma,
                         w = std::exp(-0.5 * distance * distance);
            sum += w * middle[std::clamp<std::ptrdiff_t>(s, 0, std::ssize(middle) - 1)];
            weight += w;
        }
        smooth[t] = sum / weight;
    }
    return smooth;
}

double floor_of(const JointMotion& motion) {
    std::vector<double> lowest;
    for_bodies(motion, [&](std::size_t t, std::size_t p) {
        double low = motion.at(t, p, 0)[1];
        for (std::size_t j = 1; j < motion.topology.joints(); ++j)
            low = std::min<double>(low, motion.at(t, p, j)[1]);
        lowest.push_back(low);
    });
    return percentile(lowest, 0.05);
}

/// Metres along the limbs from the root to the furthest tip, of the largest person; 1 for a body without
/// limbs.
double reach_of(const JointMotion& motion) {
    const auto k = motion.topology.joints();
    const auto lengths = limb_lengths(motion);
    double reach = 0;
    for (std::size_t p = 0; p < motion.persons; ++p) {
        std::vector<double> from_root(k, 0);
        for (const auto j : motion.topology.order())
            if (const int parent = motion.topology.parents[j]; parent >= 0) {
                from_root[j] = from_root[parent] + lengths[p * k + j];
                reach = std::max(reach, from_root[j]);
            }
    }
    return reach > 1e-6 ? reach : 1;
}

}  // namespace

std::vector<std::string> view_names() {
    std::vector<std::string> names;
    for (const auto& [name, view] : named_views) names.emplace_back(name);
    return names;
}

View parse_view(const std::string& text) {
    for (const auto& [name, view] : named_views)
        if (text == name) return view;
    View view;
    const char* end = text.data() + text.size();
    const auto azimuth = std::from_chars(text.data(), end, view.azimuth);
    if (azimuth.ec == std::errc() && azimuth.ptr != end && *azimuth.ptr == ',') {
        const auto elevation = std::from_chars(azimuth.ptr + 1, end, view.elevation);
        if (elevation.ec == std::errc() && elevation.ptr == end && std::abs(view.azimuth) <= 3600 &&
            std::abs(view.elevation) <= 90)
            return view;
    }
    throw Error(
        "'{}' is no view; give {}, or AZIMUTH,ELEVATION in degrees, as in 30,15 (elevation from -90 to 90)",
        text, fmt::join(view_names(), ", "));
}

cv::Vec3d Camera::on_floor(cv::Point2d pixel, double height) const {
    // The floor is spanned by right_ and by `away`, up_ laid flat; up_ rises by sqrt(1 - rise^2) a metre.
    const double x = (pixel.x - offset_.x) / scale_, y = (offset_.y - pixel.y) / scale_;
    const cv::Vec3d away = vertical.cross(right_);
    const double along = (y - up_[1] * (height - centre_[1])) / rise();
    cv::Vec3d out = centre_ + x * right_ + along * away;
    out[1] = height;
    return out;
}

std::vector<double> limb_lengths(const JointMotion& motion) {
    const auto k = motion.topology.joints();
    std::vector<double> out(motion.persons * k, 0);
    const std::size_t step = std::max<std::size_t>(1, motion.frames / 200);
    std::vector<double> lengths;
    for (std::size_t p = 0; p < motion.persons; ++p)
        for (std::size_t j = 1; j < k; ++j) {
            lengths.clear();
            for (std::size_t t = 0; t < motion.frames; t += step)
                if (motion.visible(t, p))
                    lengths.push_back(
                        cv::norm(point(motion, t, p, j) - point(motion, t, p, motion.topology.parents[j])));
            if (!lengths.empty()) out[p * k + j] = percentile(lengths, 0.5);
        }
    return out;
}

Side side_of(const std::string& joint_name) {
    const auto name = lower_case(joint_name);
    if (name.find("left") != std::string::npos) return Side::left;
    if (name.find("right") != std::string::npos) return Side::right;

    // "l_hip", "hip_l", "hip.R", "LHip", "lhip" is too close to "lumbar": a lone letter counts, and a capital
    // before a capital.
    const auto letter = [](char c) { return c == 'l' ? Side::left : c == 'r' ? Side::right : Side::middle; };
    const auto alpha = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    const auto capital = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
    if (name.size() < 2) return Side::middle;
    if (!alpha(name[1]) || (capital(joint_name[0]) && capital(joint_name[1]))) return letter(name[0]);
    if (!alpha(name[name.size() - 2])) return letter(name.back());
    return Side::middle;
}

Framing::Framing(const JointMotion& motion, const View& view)
    : view_(view),
      frames_(motion.frames),
      facing_(front_of(motion)),
      floor_(floor_of(motion)),
      reach_(reach_of(motion)),
      centres_(path_of_group(motion)) {
    const auto moving = centres_;
    cv::Vec3d mean{0, 0, 0};
    for (const auto& c : moving) mean += c / static_cast<double>(moving.size());

    const auto followed = extent(motion);
    centres_.assign(frames_, mean);
    box_ = extent(motion);
    // Going along pays where standing still would make the persons less than three quarters the size.
    if (std::max(box_.width, box_.height) > 1.3 * std::max(followed.width, followed.height)) {
        follows_ = true;
        centres_ = moving;
        box_ = followed;
    }
    box_ = with_room(box_, motion);
}

/// What stands out beyond the joints: limbs are thick, and so is a head; a skin as far as it does in some frames.
cv::Rect2d Framing::with_room(cv::Rect2d joints, const JointMotion& motion) const {
    const double thickness = 0.09 * reach_;
    double left = thickness, right = thickness, bottom = thickness, top = thickness;
    constexpr std::size_t frames_asked = 24;
    for (std::size_t i = 0; motion.skin && i < std::min<std::size_t>(frames_asked, frames_); ++i) {
        const auto t = i * frames_ / std::min<std::size_t>(frames_asked, frames_);
        auto camera = oriented(t);
        camera.place({0, 0, 0}, 1, {0, 0});
        const auto bounds = [&](const float* points, std::size_t count) {
            cv::Rect2d box(1e9, 1e9, -2e9, -2e9);
            for (std::size_t v = 0; v < count; ++v) {
                const auto seen = camera.project({points[3 * v], points[3 * v + 1], points[3 * v + 2]});
                const double x0 = std::min(box.x, seen.x), x1 = std::max(box.x + box.width, seen.x),
                             y0 = std::min(box.y, -seen.y), y1 = std::max(box.y + box.height, -seen.y);
                box = {x0, y0, x1 - x0, y1 - y0};
            }
            return box;
        };
        const auto skin = motion.skin->vertices(motion.rotations, t);
        const auto outer = bounds(skin.data(), skin.size() / 3),
                   inner = bounds(motion.at(t, 0, 0), motion.persons * motion.topology.joints());
        left = std::max(left, inner.x - outer.x);
        bottom = std::max(bottom, inner.y - outer.y);
        right = std::max(right, outer.br().x - inner.br().x);
        top = std::max(top, outer.br().y - inner.br().y);
    }
    return {joints.x - left, joints.y - bottom, joints.width + left + right, joints.height + bottom + top};
}

Camera Framing::oriented(std::size_t frame) const {
    const double turn = view_.orbit ? 360.0 * static_cast<double>(frame) / static_cast<double>(frames_) : 0;
    const double az = (view_.azimuth + turn) * std::numbers::pi / 180,
                 el = view_.elevation * std::numbers::pi / 180;
    const cv::Vec3d left = vertical.cross(facing_);
    const cv::Vec3d level = std::cos(az) * facing_ + std::sin(az) * left;
    return {std::cos(el) * level + std::sin(el) * vertical, vertical.cross(level)};
}

cv::Rect2d Framing::extent(const JointMotion& motion) const {
    std::vector<double> xs, ys;
    xs.reserve(motion.joints.size() / 3);
    ys.reserve(motion.joints.size() / 3);
    for (std::size_t t = 0; t < motion.frames; ++t) {
        auto camera = oriented(t);
        camera.place(centres_[t], 1, {0, 0});
        for (std::size_t p = 0; p < motion.persons; ++p)
            for (std::size_t j = 0; motion.visible(t, p) && j < motion.topology.joints(); ++j) {
                const auto seen = camera.project(point(motion, t, p, j));
                xs.push_back(seen.x);
                ys.push_back(-seen.y);
            }
    }
    const auto [left, right] = robust_range(std::move(xs));
    const auto [bottom, top] = robust_range(std::move(ys));
    return {left, bottom, right - left, top - bottom};
}

Camera Framing::camera(std::size_t frame, const cv::Rect2d& inside) const {
    auto camera = oriented(frame);
    const double scale = std::min(inside.width / box_.width, inside.height / box_.height);
    const double x = box_.x + box_.width / 2;
    // Everything stands at the same height in its cell: what room is left over goes above the heads, in part.
    const double spare = inside.height - scale * box_.height;
    camera.place(
        centres_[frame], scale,
        {inside.x + inside.width / 2 - scale * x, inside.y + inside.height - 0.4 * spare + scale * box_.y});
    return camera;
}

}  // namespace actformer::reports
