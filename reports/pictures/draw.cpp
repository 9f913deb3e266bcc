#include "reports/pictures/draw.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/text/lower_case.hpp"
#include "ingest/smpl/vertex_normals.hpp"
#include "reports/pictures/mesh.hpp"
#include "reports/pictures/style.hpp"

namespace actformer::reports {
namespace {

// Shares of a body's reach (root to furthest tip, some 1.3 m in an adult).
constexpr double thin = 0.013, thick = 0.036, head_size = 0.082;

cv::Vec3d place_of(const JointMotion& motion, std::size_t frame, std::size_t person, std::size_t joint) {
    const float* x = motion.at(frame, person, joint);
    return {x[0], x[1], x[2]};
}

JointMotion body_of(const JointMotion& motion) {
    check(motion);
    return motion;
}

/// The first joint whose name has "head" in it; -1 without one.
int head_joint(const ingest::Topology& topology) {
    for (std::size_t j = 0; j < topology.joints(); ++j)
        if (lower_case(topology.names[j]).find("head") != std::string::npos) return static_cast<int>(j);
    return -1;
}

/// The head's only child where nothing hangs on that; -1 otherwise.
int crown_joint(const ingest::Topology& topology, int head) {
    int child = -1;
    for (std::size_t j = 0; head >= 0 && j < topology.joints(); ++j)
        if (topology.parents[j] == head) {
            if (child >= 0) return -1;
            child = static_cast<int>(j);
        }
    return child >= 0 && std::ranges::find(topology.parents, child) == topology.parents.end() ? child : -1;
}

/// A joint without a side in its name takes the side of what it hangs on (fingers called "Thumb1", end
/// sites).
std::vector<Side> sides_of(const ingest::Topology& topology) {
    std::vector<Side> sides(topology.joints(), Side::middle);
    for (const auto j : topology.order()) {
        sides[j] = side_of(topology.names[j]);
        if (const int parent = topology.parents[j]; sides[j] == Side::middle && parent >= 0)
            sides[j] = sides[parent];
    }
    return sides;
}

/// (persons, K): a joint is as thick as the limbs beyond it are long, so that hands and toes come out
/// slender.
std::vector<double> joint_radii(const JointMotion& motion, double reach) {
    const auto k = motion.topology.joints();
    const auto lengths = limb_lengths(motion);
    const auto order = motion.topology.order();
    std::vector<double> radii(motion.persons * k);
    for (std::size_t p = 0; p < motion.persons; ++p) {
        std::vector<double> beyond(k, 0);
        for (auto j = order.rbegin(); j != order.rend(); ++j)
            if (const int parent = motion.topology.parents[*j]; parent >= 0)
                beyond[parent] = std::max(beyond[parent], beyond[*j] + lengths[p * k + *j]);
        for (std::size_t j = 0; j < k; ++j)
            radii[p * k + j] = reach * (thin + (thick - thin) * std::min(1.0, beyond[j] / (0.5 * reach)));
    }
    if (k == 1) std::ranges::fill(radii, thick * reach);
    return radii;
}

/// (V) how much of a vertex hangs on the body's middle, left and right.
std::vector<cv::Vec3f> skin_sides(const JointMotion& motion, const std::vector<Side>& sides) {
    if (!motion.skin) return {};
    const auto& skin = motion.skin->body().skin;
    std::vector<cv::Vec3f> out(skin.vertices(), cv::Vec3f(0, 0, 0));
    for (std::size_t v = 0; v < out.size(); ++v)
        for (auto i = skin.first[v]; i < skin.first[v + 1]; ++i) {
            const auto side = sides[skin.influences[i].joint];
            out[v][side == Side::middle ? 0 : side == Side::left ? 1 : 2] += skin.influences[i].weight;
        }
    return out;
}

double smooth_step(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// 1, 2 or 5 times a power of ten near `length`.
double round_length(double length) {
    const double power = std::pow(10, std::floor(std::log10(length)));
    const double digit = length / power;
    return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

void tint(cv::Vec3b& pixel, const cv::Vec3f& colour, double strength) {
    const auto s = static_cast<float>(strength);
    for (int c = 0; c < 3; ++c)
        pixel[c] = cv::saturate_cast<std::uint8_t>(static_cast<float>(pixel[c]) * (1 - s) + colour[c] * s);
}

}  // namespace

Stage::Stage(const JointMotion& motion, const View& view, int samples)
    : motion_(body_of(motion)),
      framing_(motion_, view),
      samples_(samples),
      sides_(sides_of(motion_.topology)),
      head_(head_joint(motion_.topology)),
      crown_(crown_joint(motion_.topology, head_)),
      radius_(joint_radii(motion_, framing_.reach())),
      skin_sides_(skin_sides(motion_, sides_)) {
    has_sides_ = std::ranges::count(sides_, Side::left) > 0 && std::ranges::count(sides_, Side::right) > 0;
}

Camera Stage::camera(std::size_t frame, const cv::Size& cell) const {
    const double margin = 0.03 * cell.height;
    return framing_.camera(frame, {margin, margin, cell.width - 2 * margin, cell.height - 2 * margin});
}

std::vector<Cone> Stage::limbs(const Camera& camera, std::size_t frame) const {
    const auto k = motion_.topology.joints();
    std::vector<Cone> cones;
    for (std::size_t p = 0; p < motion_.persons; ++p) {
        if (!motion_.visible(frame, p)) continue;
        const auto radius = [&](std::size_t j) { return std::max(0.8, radius_[p * k + j] * camera.scale()); };
        const auto at = [&](std::size_t j) { return camera.project(place_of(motion_, frame, p, j)); };
        const auto colour = [&](std::size_t j) { return this->colour(p, sides_[j]); };
        for (std::size_t j = 1; j < k; ++j) {
            const auto parent = static_cast<std::size_t>(motion_.topology.parents[j]);
            // A limb is no thicker where it leaves a thicker part (clavicle from the spine) than half its
            // parent's more.
            cones.push_back(
                {at(parent), at(j), std::min(radius(parent), 1.6 * radius(j)), radius(j), colour(j)});
        }
        if (k == 1) cones.push_back({at(0), at(0), radius(0), radius(0), colour(0)});
        if (head_ >= 0) {
            auto centre = place_of(motion_, frame, p, static_cast<std::size_t>(head_));
            if (crown_ >= 0)
                centre = 0.5 * (centre + place_of(motion_, frame, p, static_cast<std::size_t>(crown_)));
            const auto seen = camera.project(centre);
            const double r = std::max(1.6, head_size * framing_.reach() * camera.scale());
            cones.push_back({seen, seen, r, r, colour(static_cast<std::size_t>(head_))});
        }
    }
    return cones;
}

void Stage::draw(cv::Mat& cell, std::size_t frame) const {
    const auto eye = camera(frame, cell.size());
    if (eye.rise() > 0.05) {
        draw_floor(cell, eye);
        draw_shadow(cell, eye, frame);
    }
    motion_.skin ? draw_skin(cell, eye, frame)
                 : draw_solid(cell, limbs(eye, frame), samples_, style::vec(style::paper));
}

void Stage::draw_skin(cv::Mat& cell, const Camera& eye, std::size_t frame) const {
    const auto& body = motion_.skin->body();
    const auto skin = motion_.skin->vertices(motion_.rotations, frame);
    const auto numbers = body.skin.rest.size();
    std::vector<MeshCorner> corners;
    std::vector<std::uint32_t> faces;
    for (std::size_t p = 0; p < motion_.persons; ++p) {
        const auto own = std::span(skin).subspan(p * numbers, numbers);
        const auto normals = ingest::vertex_normals(own, body.faces);
        for (const auto v : body.faces) faces.push_back(v + static_cast<std::uint32_t>(corners.size()));
        const auto middle = colour(p, Side::middle), left = colour(p, Side::left),
                   right = colour(p, Side::right);
        for (std::size_t v = 0; v < numbers / 3; ++v) {
            const auto& sides = skin_sides_[v];
            const float *at = &own[3 * v], *n = &normals[3 * v];
            corners.push_back({eye.project({at[0], at[1], at[2]}), eye.turned({n[0], n[1], n[2]}),
                               sides[0] * middle + sides[1] * left + sides[2] * right});
        }
    }
    draw_mesh(cell, corners, faces, samples_, style::vec(style::paper));
}

cv::Vec3f Stage::colour(std::size_t person, Side side) const {
    const auto& body = style::body(person);
    if (!has_sides_) return style::vec(body.left);
    return style::vec(side == Side::middle ? body.middle : side == Side::left ? body.left : body.right);
}

/// A disc of floor under the persons that fades out, with a grid of round spacing.
void Stage::draw_floor(cv::Mat& cell, const Camera& eye) const {
    const double spacing = round_length(0.35 * framing_.reach());
    const double across = cell.cols / eye.scale(), disc = 0.5 * across;
    const cv::Vec3d ahead = framing_.facing(), aside = cv::Vec3d(0, 1, 0).cross(ahead);
    const auto floor_colour = style::vec(style::floor), grid_colour = style::vec(style::grid);
    // Under the persons as seen from the front, in the middle of the cell from side to side.
    const cv::Vec3d away = cv::Vec3d(0, 1, 0).cross(eye.right());
    cv::Vec3d middle = eye.on_floor({cell.cols / 2.0, 0}, framing_.floor());
    middle -= away * away.dot(middle - eye.centre());

    for (int y = 0; y < cell.rows; ++y) {
        const double edge =
            smooth_step(0, 0.08 * cell.rows, std::min(y, cell.rows - 1 - y));  // no cut at the cell's border
        // The floor is an affine image of the picture: one look-up a row and one step a pixel suffice.
        cv::Vec3d at = eye.on_floor({0.5, y + 0.5}, framing_.floor());
        const cv::Vec3d step = eye.on_floor({1.5, y + 0.5}, framing_.floor()) - at;
        const cv::Vec3d down = eye.on_floor({0.5, y + 1.5}, framing_.floor()) - at;
        const double footprint_a = std::hypot(step.dot(ahead), down.dot(ahead));
        const double footprint_b = std::hypot(step.dot(aside), down.dot(aside));
        for (int x = 0; x < cell.cols; ++x, at += step) {
            const double far = cv::norm(at - middle);
            if (far >= disc) continue;
            const double fade = edge * (1 - smooth_step(0.35 * disc, disc, far));
            const auto line = [&](const cv::Vec3d& axis, double footprint) {
                const double g = at.dot(axis), distance = std::abs(g - spacing * std::round(g / spacing));
                const double legible =
                    smooth_step(3, 9, spacing / footprint);  // lines that crowd would only shimmer
                return legible * std::clamp(1.15 - distance / footprint, 0.0, 1.0);
            };
            auto& pixel = cell.at<cv::Vec3b>(y, x);
            tint(pixel, floor_colour, fade);
            tint(pixel, grid_colour, fade * std::max(line(ahead, footprint_a), line(aside, footprint_b)));
        }
    }
}

/// What the bodies keep from a light straight above, softer and weaker the higher they are. Drawn as a plan
/// of the floor, then laid into the picture.
void Stage::draw_shadow(cv::Mat& cell, const Camera& eye, std::size_t frame) const {
    const auto k = motion_.topology.joints();
    const double reach = framing_.reach(), blur = 0.03 * reach,
                 per_metre = std::min(eye.scale() / 2, 60 / reach);
    struct Print {
        cv::Point2d a, b;
        double radius, darkness;
    };
    std::vector<Print> prints;
    const cv::Vec3d away = cv::Vec3d(0, 1, 0).cross(eye.right());
    const auto plan = [&](const cv::Vec3d& x) {
        const cv::Vec3d d = x - eye.centre();
        return cv::Point2d(per_metre * eye.right().dot(d), per_metre * away.dot(d));
    };
    const double limit = 4 * cell.cols / eye.scale() * per_metre;  // a joint that flew off casts no shadow
    for (std::size_t p = 0; p < motion_.persons; ++p)
        for (std::size_t j = 0; motion_.visible(frame, p) && j < k; ++j) {
            const auto parent = static_cast<std::size_t>(std::max(0, motion_.topology.parents[j]));
            const auto a = place_of(motion_, frame, p, parent), b = place_of(motion_, frame, p, j);
            const double height = std::max(0.0, 0.5 * (a[1] + b[1]) - framing_.floor());
            const Print print{plan(a), plan(b), 1.3 * radius_[p * k + j] * per_metre,
                              std::exp(-height / (0.45 * reach))};
            if (cv::norm(print.a) < limit && cv::norm(print.b) < limit) prints.push_back(print);
        }
    if (prints.empty()) return;
    std::ranges::sort(prints, {}, &Print::darkness);

    double left = 1e9, right = -1e9, near = 1e9, far = -1e9;
    for (const auto& print : prints) {
        left = std::min({left, print.a.x, print.b.x});
        right = std::max({right, print.a.x, print.b.x});
        near = std::min({near, print.a.y, print.b.y});
        far = std::max({far, print.a.y, print.b.y});
    }
    const double margin = 4 * blur * per_metre + 0.1 * reach * per_metre + 2;
    const cv::Point2d corner(left - margin, near - margin);
    cv::Mat dark(static_cast<int>(far - near + 2 * margin) + 1,
                 static_cast<int>(right - left + 2 * margin) + 1, CV_8U, cv::Scalar(0));
    constexpr int shift = 4;
    const auto fixed = [&](const cv::Point2d& x) {
        return cv::Point(static_cast<int>((x.x - corner.x) * (1 << shift)),
                         static_cast<int>((x.y - corner.y) * (1 << shift)));
    };
    for (const auto& print : prints)
        cv::line(dark, fixed(print.a), fixed(print.b), cv::Scalar(255 * print.darkness),
                 std::max(1, static_cast<int>(2 * print.radius + 0.5)), cv::LINE_AA, shift);
    cv::GaussianBlur(dark, dark, {}, std::max(0.7, blur * per_metre));

    const auto colour = style::vec(style::shadow);
    for (int y = 0; y < cell.rows; ++y)
        for (int x = 0; x < cell.cols; ++x) {
            const auto at = plan(eye.on_floor({x + 0.5, y + 0.5}, framing_.floor())) - corner;
            const int u = static_cast<int>(std::floor(at.x)), v = static_cast<int>(std::floor(at.y));
            if (u < 0 || v < 0 || u + 1 >= dark.cols || v + 1 >= dark.rows) continue;
            const double fu = at.x - u, fv = at.y - v;
            const double d =
                (1 - fv) * ((1 - fu) * dark.at<std::uint8_t>(v, u) + fu * dark.at<std::uint8_t>(v, u + 1)) +
                fv * ((1 - fu) * dark.at<std::uint8_t>(v + 1, u) + fu * dark.at<std::uint8_t>(v + 1, u + 1));
            tint(cell.at<cv::Vec3b>(y, x), colour, 0.42 * d / 255);
        }
}

}  // namespace actformer::reports
