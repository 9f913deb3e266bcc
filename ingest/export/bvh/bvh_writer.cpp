#include "ingest/export/bvh/bvh_writer.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

namespace actformer::ingest {
namespace {

constexpr double centimetres = 100, degrees = 180 / std::numbers::pi;

/// Three numbers with six decimals, a blank before each; no minus before nothing but zeros.
void append(std::string& text, double a, double b, double c) {
    constexpr double vanishes = 0.5e-6;
    for (const double v : {a, b, c})
        fmt::format_to(std::back_inserter(text), FMT_COMPILE(" {:.6f}"), std::abs(v) <= vanishes ? 0.0 : v);
}

void append_metres(std::string& text, const Point& p) {
    append(text, p[0] * centimetres, p[1] * centimetres, p[2] * centimetres);
}

class Writer {
  public:
    Writer(const SkeletonMotion& motion, double fps)
        : motion_(motion), fps_(fps), children_(motion.joints()) {
        for (std::size_t j = 1; j < motion.joints(); ++j) children_[motion.topology.parents[j]].push_back(j);
    }

    std::string text() {
        text_ = "HIERARCHY\n";
        write_joint(0, "");
        fmt::format_to(std::back_inserter(text_), "MOTION\nFrames: {}\nFrame Time: {:.9g}\n", motion_.frames,
                       1 / fps_);
        std::vector<Point> before(motion_.joints(), Point{});
        for (std::size_t t = 0; t < motion_.frames; ++t) write_frame(t, before);
        return std::move(text_);
    }

  private:
    // Trees may be as deep as they have joints: a stack of calls would be too.
    void write_joint(std::size_t root, const std::string& outermost) {
        struct Open {
            std::size_t joint, next_child;
        };
        std::vector<Open> open;
        std::string indent = outermost;
        const auto begin = [&](std::size_t joint) {
            fmt::format_to(std::back_inserter(text_), "{}{} {}\n{}{{\n", indent,
                           joint == root ? "ROOT" : "JOINT", motion_.topology.names[joint], indent);
            indent += '\t';
            text_ += indent + "OFFSET";
            append_metres(text_, motion_.rest[joint]);
            text_ += "\n" + indent +
                     (motion_.slides[joint] ? "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
                                              "Yrotation\n"
                                            : "CHANNELS 3 Zrotation Xrotation Yrotation\n");
            if (children_[joint].empty())
                text_ +=
                    indent + "End Site\n" + indent + "{\n" + indent + "\tOFFSET 0 0 0\n" + indent + "}\n";
            order_.push_back(joint);
            open.push_back({joint, 0});
        };
        begin(root);
        while (!open.empty()) {
            auto& last = open.back();
            if (last.next_child < children_[last.joint].size()) {
                begin(children_[last.joint][last.next_child++]);
            } else {
                open.pop_back();
                indent.pop_back();
                text_ += indent + "}\n";
            }
        }
    }

    void write_frame(std::size_t frame, std::vector<Point>& before) {
        const auto begin = text_.size();
        for (const auto j : order_) {
            if (motion_.slides[j]) append_metres(text_, motion_.place(frame, j));
            before[j] = zxy_degrees(motion_.turn(frame, j), before[j]);
            append(text_, before[j][0], before[j][1], before[j][2]);
        }
        text_.erase(begin, 1);
        text_ += '\n';
    }

    const SkeletonMotion& motion_;
    double fps_;
    std::vector<std::vector<std::size_t>> children_;
    std::vector<std::size_t> order_;  ///< joints as the file has them
    std::string text_;
};

/// `angles` and whole turns, as near to `before` as they come.
Point unwound(Point angles, const Point& before) {
    for (std::size_t i = 0; i < 3; ++i) angles[i] = before[i] + std::remainder(angles[i] - before[i], 360);
    return angles;
}

double distance(const Point& a, const Point& b) {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

}  // namespace

Point zxy_degrees(const Quaternion& q, const Point& before) {
    // The matrix Z X Y has sin x at (2, 1), -sin z cos x and cos z cos x above it, -cos x sin y and cos x cos y beside it.
    const double sin_x = 2 * (q.y * q.z + q.w * q.x);
    const double m01 = 2 * (q.x * q.y - q.w * q.z), m11 = 1 - 2 * (q.x * q.x + q.z * q.z);
    const double m20 = 2 * (q.x * q.z - q.w * q.y), m22 = 1 - 2 * (q.x * q.x + q.y * q.y);
    const double cos_x = std::hypot(m01, m11);
    const double x = std::atan2(sin_x, cos_x) * degrees;
    constexpr double locked = 1e-7;
    if (cos_x < locked) {  // z and y turn about one axis: y stays, z does it all
        const double m00 = 1 - 2 * (q.y * q.y + q.z * q.z), m10 = 2 * (q.x * q.y + q.w * q.z);
        const double both = std::atan2(m10, m00) * degrees;
        return unwound({sin_x > 0 ? both - before[2] : both + before[2], x, before[2]}, before);
    }
    const double z = std::atan2(-m01, m11) * degrees, y = std::atan2(-m20, m22) * degrees;
    const auto one = unwound({z, x, y}, before), other = unwound({z + 180, 180 - x, y + 180}, before);
    return distance(one, before) <= distance(other, before) ? one : other;
}

std::string bvh_text(const SkeletonMotion& motion, double fps) {
    return Writer(motion, fps).text();
}

}  // namespace actformer::ingest
