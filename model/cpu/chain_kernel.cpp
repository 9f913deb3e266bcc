// A vector's lanes are poses: every formula is a scalar's.
#include "model/cpu/chain_kernel.hpp"

#include <algorithm>

#include "model/cpu/kernel_support.hpp"
#include "model/cpu/vector_math.hpp"

namespace actformer::model::cpu {
namespace {

constexpr double least_square = 1e-4;

/// What scratch memory is for.
struct PoseLanes {};
struct BoneLanes {};
struct JointLanes {};
struct JointGrad {};
struct PoseGrad {};

struct DoubleTurn {
    Doubles cosine, sine;
};

inline Turn turn_by(Floats angle) {
    return turned(angle * 0.15915494309F);
}

inline DoubleTurn turn_by(Doubles angle) {
    return {each(angle, [](double x) { return std::cos(x); }),
            each(angle, [](double x) { return std::sin(x); })};
}

template <typename T>
struct Vector3 {
    Lanes<T> x, y, z;
};

/// Row by row.
template <typename T>
struct Matrix {
    Lanes<T> m[9];
};

template <typename T>
Matrix<T> identity() {
    Matrix<T> out{};
    out.m[0] = out.m[4] = out.m[8] = Lanes<T>{} + T(1);
    return out;
}

template <typename T>
Matrix<T> multiplied(const Matrix<T>& a, const Matrix<T>& b) {
    Matrix<T> out;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            out.m[3 * i + j] =
                a.m[3 * i] * b.m[j] + a.m[3 * i + 1] * b.m[3 + j] + a.m[3 * i + 2] * b.m[6 + j];
    return out;
}

template <typename T>
Matrix<T> transposed(const Matrix<T>& a) {
    return {{a.m[0], a.m[3], a.m[6], a.m[1], a.m[4], a.m[7], a.m[2], a.m[5], a.m[8]}};
}

/// exp(w) = I + a W + b W^2, a = sin t / t, b = (1 - cos t) / t^2.
template <typename T>
struct Rodrigues {
    Vector3<T> w;
    Lanes<T> length, square, a, b, a_slope,
        b_slope;  ///< length: |w|^2, square: at least least_square; slopes by it

    explicit Rodrigues(const Vector3<T>& w_) : w(w_) {
        length = w.x * w.x + w.y * w.y + w.z * w.z;
        const auto least = Lanes<T>{} + static_cast<T>(least_square);
        square = length > least ? length : least;
        const auto angle = root(square);
        const auto turn = turn_by(angle);
        a = turn.sine / angle;
        b = (1 - turn.cosine) / square;
        a_slope = (turn.cosine - a) / (2 * square);
        b_slope = (a - 2 * b) / (2 * square);
    }

    Matrix<T> rotation() const {
        const auto [x, y, z] = w;
        Matrix<T> out;
        out.m[0] = 1 + b * (x * x - length);
        out.m[1] = b * x * y - a * z;
        out.m[2] = b * x * z + a * y;
        out.m[3] = b * x * y + a * z;
        out.m[4] = 1 + b * (y * y - length);
        out.m[5] = b * y * z - a * x;
        out.m[6] = b * x * z - a * y;
        out.m[7] = b * y * z + a * x;
        out.m[8] = 1 + b * (z * z - length);
        return out;
    }

    /// The gradient to w of one to the rotation.
    Vector3<T> backward(const Matrix<T>& g) const {
        const auto [x, y, z] = w;
        const auto gx = g.m[7] - g.m[5], gy = g.m[2] - g.m[6], gz = g.m[3] - g.m[1];
        const auto trace = g.m[0] + g.m[4] + g.m[8];
        const auto sx = 2 * g.m[0] * x + (g.m[1] + g.m[3]) * y + (g.m[2] + g.m[6]) * z,
                   sy = (g.m[1] + g.m[3]) * x + 2 * g.m[4] * y + (g.m[5] + g.m[7]) * z,
                   sz = (g.m[2] + g.m[6]) * x + (g.m[5] + g.m[7]) * y + 2 * g.m[8] * z;
        const auto to_a = gx * x + gy * y + gz * z, to_b = (sx * x + sy * y + sz * z) / 2 - length * trace;
        const auto slope = 2 * (to_a * a_slope + to_b * b_slope);
        const auto by_square = length > static_cast<T>(least_square) ? slope : Lanes<T>{};
        const auto along = by_square - 2 * b * trace;
        return {a * gx + b * sx + along * x, a * gy + b * sy + along * y, a * gz + b * sz + along * z};
    }
};

/// A few rows (count, columns) with a vector a column, and back.
template <typename T>
void to_lanes(const T* rows, std::int64_t count, std::int64_t columns, T* to) {
    for (std::int64_t c = 0; c < columns; ++c)
        for (std::int64_t i = 0; i < lanes<T>; ++i)
            to[c * lanes<T> + i] = i < count ? rows[i * columns + c] : T(0);
}

template <typename T>
void from_lanes(const T* from, std::int64_t count, std::int64_t columns, T* rows) {
    for (std::int64_t i = 0; i < count; ++i)
        for (std::int64_t c = 0; c < columns; ++c) rows[i * columns + c] = from[c * lanes<T> + i];
}

template <typename T>
Vector3<T> joint_at(const T* from, int joint) {
    from += 3 * joint * lanes<T>;
    return {load(from), load(from + lanes<T>), load(from + 2 * lanes<T>)};
}

template <typename T>
void put_joint(T* to, int joint, const Vector3<T>& v) {
    to += 3 * joint * lanes<T>;
    store(to, v.x);
    store(to + lanes<T>, v.y);
    store(to + 2 * lanes<T>, v.z);
}

/// A bone as it points where nothing is rotated.
template <typename T>
struct Bone {
    Lanes<T> x, y, z;

    Bone(const Chains& chains, const T* bones, int joint) {
        const auto& d = chains.directions[static_cast<std::size_t>(joint)];
        const auto length = load(bones + joint * lanes<T>);
        x = length * static_cast<T>(d[0]);
        y = length * static_cast<T>(d[1]);
        z = length * static_cast<T>(d[2]);
    }
};

template <typename T>
void follow_chain(const Chains& chains, const std::vector<int>& chain, const T* poses, const T* bones,
                  T* joints) {
    auto rotation = identity<T>();
    auto at = joint_at(joints, chain[0]);
    for (std::size_t i = 1; i < chain.size(); ++i) {
        rotation = multiplied(rotation, Rodrigues<T>(joint_at(poses, chain[i])).rotation());
        const Bone<T> bone(chains, bones, chain[i]);
        const auto* m = rotation.m;
        at.x += m[0] * bone.x + m[1] * bone.y + m[2] * bone.z;
        at.y += m[3] * bone.x + m[4] * bone.y + m[5] * bone.z;
        at.z += m[6] * bone.x + m[7] * bone.y + m[8] * bone.z;
        put_joint(joints, chain[i], at);
    }
}

/// `grad`, to the joints, becomes what reaches the chain's first joint; `to` gets the gradients of its rotations.
template <typename T>
void follow_chain_backward(const Chains& chains, const std::vector<int>& chain, const T* poses,
                           const T* bones, T* grad, T* to) {
    std::array<Matrix<T>, Chains::most_links> rotations;
    rotations[0] = identity<T>();
    for (std::size_t i = 1; i < chain.size(); ++i)
        rotations[i] = multiplied(rotations[i - 1], Rodrigues<T>(joint_at(poses, chain[i])).rotation());
    Matrix<T> to_rotation{};
    Vector3<T> sum{};
    for (std::size_t i = chain.size() - 1; i > 0; --i) {
        const auto g = joint_at(grad, chain[i]);
        sum = {sum.x + g.x, sum.y + g.y, sum.z + g.z};
        const Bone<T> bone(chains, bones, chain[i]);
        const Lanes<T> rows[3] = {sum.x, sum.y, sum.z};
        for (int r = 0; r < 3; ++r) {
            to_rotation.m[3 * r] += rows[r] * bone.x;
            to_rotation.m[3 * r + 1] += rows[r] * bone.y;
            to_rotation.m[3 * r + 2] += rows[r] * bone.z;
        }
        const Rodrigues<T> turn(joint_at(poses, chain[i]));
        put_joint(to, chain[i], turn.backward(multiplied(transposed(rotations[i - 1]), to_rotation)));
        to_rotation = multiplied(to_rotation, transposed(turn.rotation()));
    }
    const auto first = joint_at(grad, chain[0]);
    put_joint(grad, chain[0], {first.x + sum.x, first.y + sum.y, first.z + sum.z});
}

}  // namespace

template <typename T>
void chain_kinematics(const Chains& chains, std::int64_t rows, const T* poses, const T* bones, T* joints) {
    const auto count = chains.count(), numbers = 3 * count;
    T *pose = scratch<T>(PoseLanes{}, numbers * lanes<T>), *bone = scratch<T>(BoneLanes{}, count * lanes<T>),
      *joint = scratch<T>(JointLanes{}, numbers * lanes<T>);
    for (std::int64_t row = 0; row < rows; row += lanes<T>) {
        const auto here = std::min<std::int64_t>(lanes<T>, rows - row);
        to_lanes(poses + row * numbers, here, numbers, pose);
        to_lanes(bones + row * count, here, count, bone);
        put_joint(joint, 0, joint_at(pose, 0));
        for (const auto& chain : chains.joints) follow_chain(chains, chain, pose, bone, joint);
        from_lanes(joint, here, numbers, joints + row * numbers);
    }
}

template <typename T>
void chain_kinematics_backward(const Chains& chains, std::int64_t rows, const T* poses, const T* bones,
                               const T* grad, T* to) {
    const auto count = chains.count(), numbers = 3 * count;
    T *pose = scratch<T>(PoseLanes{}, numbers * lanes<T>), *bone = scratch<T>(BoneLanes{}, count * lanes<T>),
      *to_joint = scratch<T>(JointGrad{}, numbers * lanes<T>),
      *to_pose = scratch<T>(PoseGrad{}, numbers * lanes<T>);
    for (std::int64_t row = 0; row < rows; row += lanes<T>) {
        const auto here = std::min<std::int64_t>(lanes<T>, rows - row);
        to_lanes(poses + row * numbers, here, numbers, pose);
        to_lanes(bones + row * count, here, count, bone);
        to_lanes(grad + row * numbers, here, numbers, to_joint);
        for (auto chain = chains.joints.rbegin(); chain != chains.joints.rend(); ++chain)
            follow_chain_backward(chains, *chain, pose, bone, to_joint, to_pose);
        put_joint(to_pose, 0, joint_at(to_joint, 0));
        from_lanes(to_pose, here, numbers, to + row * numbers);
    }
}

#define ACTFORMER_CHAINS(T)                                                                 \
    template void chain_kinematics<T>(const Chains&, std::int64_t, const T*, const T*, T*); \
    template void chain_kinematics_backward<T>(const Chains&, std::int64_t, const T*, const T*, const T*, T*);
ACTFORMER_CHAINS(float)
ACTFORMER_CHAINS(double)

}  // namespace actformer::model::cpu
