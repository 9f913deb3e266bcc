// A body model's file made up for tests, in SMPL's layout: a figure of rounded tubes about the bones of the generic skeleton. One of its
// two shape directions makes it taller, the other wider; its pose blend shapes bulge where joints bend.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "ingest/export/npz/npz_writer.hpp"
#include "ingest/smpl/smpl24.hpp"

namespace actformer::test {

struct MadeArray {
    std::vector<std::uint64_t> shape;
    std::vector<double> values;
};

/// By the names of SMPL's keys.
using MadeBody = std::map<std::string, MadeArray>;

class BodyMaker {
  public:
    /// `around` corners on each of `rings` rings a tube.
    BodyMaker(std::size_t around, std::size_t rings) : around_(around), rings_(rings) {
        const auto offsets = ingest::generic_skeleton().offsets;
        for (std::size_t k = 0; k < 24; ++k)
            for (std::size_t d = 0; d < 3; ++d)
                joints_[k][d] = offsets[3 * k + d] + (k == 0 ? 0 : joints_[parent(k)][d]);
    }

    MadeBody make() {
        // Pelvis to neck, head; hips, legs, feet, collars, arms, hands: radii at both ends, depth as a share of the width.
        tube(0, 3, 0.150, 0.135, 0.72);
        tube(3, 6, 0.135, 0.140, 0.72);
        tube(6, 9, 0.140, 0.150, 0.70);
        tube(9, 12, 0.150, 0.060, 0.75);
        tube(12, 15, 0.055, 0.055, 1);
        tube(15, {0, 0.13, 0.02}, 0.080, 0.085, 1.1);
        for (const std::size_t side : {0U, 1U}) {
            tube(0, 1 + side, 0.110, 0.095, 1);
            tube(1 + side, 4 + side, 0.088, 0.058, 1);
            tube(4 + side, 7 + side, 0.056, 0.038, 1);
            tube(7 + side, 10 + side, 0.040, 0.036, 1);
            tube(10 + side, {0, 0, 0.06}, 0.036, 0.026, 1);
            tube(9, 13 + side, 0.090, 0.070, 1);
            tube(13 + side, 16 + side, 0.070, 0.055, 1);
            tube(16 + side, 18 + side, 0.050, 0.040, 1);
            tube(18 + side, 20 + side, 0.039, 0.027, 1);
            tube(20 + side, 22 + side, 0.030, 0.032, 0.7);
            tube(22 + side, {side == 0 ? 0.07 : -0.07, 0, 0}, 0.032, 0.016, 0.7);
        }
        return arrays();
    }

  private:
    using Point = std::array<double, 3>;

    static std::size_t parent(std::size_t k) { return static_cast<std::size_t>(ingest::smpl24_parents[k]); }

    void tube(std::size_t joint, std::size_t child, double from, double to, double flat) {
        Point way{};
        for (std::size_t d = 0; d < 3; ++d) way[d] = joints_[child][d] - joints_[joint][d];
        tube(joint, way, from, to, flat, static_cast<int>(child));
    }

    /// Its rings run from behind the joint to beyond the end of `way`, and close in caps.
    void tube(std::size_t joint, const Point& way, double from, double to, double flat, int child = -1) {
        const double length = std::hypot(way[0], way[1], way[2]), before = 0.8 * from,
                     whole = length + before + 0.8 * to;
        Point along{};
        for (std::size_t d = 0; d < 3; ++d) along[d] = way[d] / length;
        auto side = cross(along, std::fabs(along[2]) < 0.9 ? Point{0, 0, 1} : Point{1, 0, 0});
        const double n = std::hypot(side[0], side[1], side[2]);
        for (auto& v : side) v /= n;
        const auto depth = cross(along, side);

        const auto first = places_.size() / 3;
        for (std::size_t r = 0; r < rings_; ++r) {
            const double u = static_cast<double>(r) / static_cast<double>(rings_ - 1),
                         reach = whole * u - before, full = from + (to - from) * u;
            const double width = full * std::pow(std::sin(std::numbers::pi * u), 0.4) + 1e-4;
            for (std::size_t i = 0; i < around_; ++i) {
                const double a = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(around_);
                for (std::size_t d = 0; d < 3; ++d)
                    places_.push_back(joints_[joint][d] + along[d] * reach +
                                      width * (std::cos(a) * side[d] + flat * std::sin(a) * depth[d]));
                add_weights(joint, child, std::clamp(0.5 - reach / (2 * from), 0.0, 0.5),
                            std::clamp(0.5 + (reach - length) / (2 * to), 0.0, 0.5));
            }
        }
        add_faces(first);
        // The rings before and behind the joint, in the shares that meet in it.
        const double at = before / whole * static_cast<double>(rings_ - 1), ring = std::floor(at);
        if (centres_[joint].empty())
            for (std::size_t i = 0; i < around_; ++i)
                for (const auto& [row, share] : {std::pair{ring, 1 - at + ring}, {ring + 1, at - ring}})
                    centres_[joint].emplace_back(first + static_cast<std::size_t>(row) * around_ + i,
                                                 share / static_cast<double>(around_));
    }

    void add_weights(std::size_t joint, int child, double near_parent, double near_child) {
        std::array<double, 24> share{};
        if (joint == 0) near_parent = 0;
        if (child < 0) near_child = 0;
        if (joint > 0) share[parent(joint)] = near_parent;
        if (child >= 0) share[static_cast<std::size_t>(child)] = near_child;
        share[joint] = 1 - near_parent - near_child;
        weights_.insert(weights_.end(), share.begin(), share.end());
    }

    void add_faces(std::size_t first) {
        for (std::size_t r = 0; r + 1 < rings_; ++r)
            for (std::size_t i = 0; i < around_; ++i) {
                const auto corner = [&](std::size_t row, std::size_t at) {
                    return static_cast<double>(first + row * around_ + at % around_);
                };
                for (const double v : {corner(r, i), corner(r, i + 1), corner(r + 1, i), corner(r + 1, i),
                                       corner(r, i + 1), corner(r + 1, i + 1)})
                    faces_.push_back(v);
            }
    }

    MadeBody arrays() const {
        const auto vertices = places_.size() / 3;
        MadeBody body;
        body["v_template"] = {{vertices, 3}, places_};
        body["weights"] = {{vertices, 24}, weights_};
        body["f"] = {{faces_.size() / 3, 3}, faces_};
        auto& shapes = body["shapedirs"] = {{vertices, 3, 2}, std::vector<double>(vertices * 6, 0.0)};
        for (std::size_t v = 0; v < vertices; ++v) {
            shapes.values[(3 * v + 1) * 2] = 0.05 * places_[3 * v + 1];
            for (const std::size_t d : {0U, 2U})
                shapes.values[(3 * v + d) * 2 + 1] = 0.1 * places_[3 * v + d];
        }
        auto& bulges = body["posedirs"] = {{vertices, 3, 207}, std::vector<double>(vertices * 621, 0.0)};
        for (std::size_t i = 0; i < vertices * 3; ++i)
            for (std::size_t f = 0; f < 207; ++f)
                bulges.values[i * 207 + f] =
                    0.01 * weights_[i / 3 * 24 + 1 + f / 9] * std::sin(static_cast<double>(i % 3 + f));
        auto& regressor = body["J_regressor"] = {{24, vertices}, std::vector<double>(24 * vertices, 0.0)};
        auto& tree = body["kintree_table"] = {{2, 24}, std::vector<double>(48)};
        for (std::size_t k = 0; k < 24; ++k) {
            for (const auto& [v, share] : centres_[k]) regressor.values[k * vertices + v] = share;
            tree.values[k] = k == 0 ? 4294967295.0 : ingest::smpl24_parents[k];
            tree.values[24 + k] = static_cast<double>(k);
        }
        return body;
    }

    static Point cross(const Point& a, const Point& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }

    std::size_t around_, rings_;
    std::array<Point, 24> joints_{};
    std::vector<double> places_, weights_, faces_;
    std::array<std::vector<std::pair<std::size_t, double>>, 24> centres_;  ///< vertex, share
};

inline MadeBody made_body(std::size_t around = 6, std::size_t rings = 6) {
    return BodyMaker(around, rings).make();
}

/// As a .npz, whole numbers where SMPL has them.
inline void write_body(const std::filesystem::path& path, const MadeBody& body) {
    ingest::NpzWriter file(path);
    for (const auto& [key, array] : body)
        if (key == "f" || key == "kintree_table")
            file.add(key, array.shape, std::vector<std::int64_t>(array.values.begin(), array.values.end()));
        else
            file.add(key, array.shape, array.values);
    file.finish();
}

}  // namespace actformer::test
