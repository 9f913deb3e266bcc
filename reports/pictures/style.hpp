// The colours and measures that every picture shares.
#pragma once

#include <array>
#include <cstddef>
#include <opencv2/core.hpp>

namespace actformer::reports::style {

/// BGR from 0xRRGGBB.
constexpr std::array<int, 3> bgr(int rgb) {
    return {rgb & 255, (rgb >> 8) & 255, rgb >> 16};
}
inline cv::Vec3f vec(int rgb) {
    const auto c = bgr(rgb);
    return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}
inline cv::Scalar scalar(int rgb) {
    const auto c = bgr(rgb);
    return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

constexpr int paper = 0xFFFFFF, floor = 0xF6F8FA, grid = 0xCDD4DE, shadow = 0x1F2A3D;
constexpr int ink = 0x1C2430, quiet_ink = 0x77818F, rule = 0xE3E7ED;

/// A person's colours: trunk and head, left limbs, right limbs. Hues of one family that stay apart for
/// colour-blind readers.
struct Body {
    int middle, left, right;
};
constexpr std::array<Body, 6> bodies{{
    {0x39518A, 0x2F80ED, 0x1FB6A6},  // blue: sky and teal
    {0xA3431B, 0xEB5E28, 0xF4A91F},  // orange: vermilion and amber
    {0x5B3A8C, 0x8B5CF6, 0xD75BC0},  // violet: lilac and orchid
    {0x2C6B3F, 0x2FA55A, 0x9CC23C},  // green: leaf and lime
    {0x8A2545, 0xD1345B, 0xF08A8A},  // red: crimson and rose
    {0x4A4F59, 0x6B7280, 0xA3ABB8},  // grey: slate and silver
}};
inline const Body& body(std::size_t person) {
    return bodies[person % bodies.size()];
}

}  // namespace actformer::reports::style
