// A vector's lanes are frames.
#include "model/cpu/forward_kinematics.hpp"

#include "model/cpu/gram_schmidt.hpp"
#include "model/cpu/kernel_support.hpp"

namespace actformer::model::cpu {
namespace {

/// What scratch memory is for.
struct MadeRows {};
struct RealRows {};
struct ToRows {};
struct MadeTurns {};
struct RealTurns {};

/// Three rows.
template <typename T>
struct Rotation {
    Vectors<T> row[axes];

    explicit Rotation(const Orthonormal<T>& rows)
        : row{rows.first(), rows.second(), cross(rows.first(), rows.second())} {}
    Rotation() : row{} {}

    Vectors<T> operator*(const Vectors<T>& v) const {
        return {dot(row[0], v), dot(row[1], v), dot(row[2], v)};
    }
    Rotation operator*(const Rotation& other) const {
        Rotation out;
        for (std::int64_t r = 0; r < axes; ++r)
            for (std::int64_t c = 0; c < axes; ++c)
                out.row[r][c] =
                    row[r][0] * other.row[0][c] + row[r][1] * other.row[1][c] + row[r][2] * other.row[2][c];
        return out;
    }
    Rotation transposed() const {
        Rotation out;
        for (std::int64_t r = 0; r < axes; ++r)
            for (std::int64_t c = 0; c < axes; ++c) out.row[r][c] = row[c][r];
        return out;
    }
    void operator+=(const Rotation& other) {
        for (std::int64_t r = 0; r < axes; ++r)
            for (std::int64_t c = 0; c < axes; ++c) row[r][c] += other.row[r][c];
    }
};

/// What is known of a joint in some frames, and the gradients to it.
template <typename T>
struct Turn {
    Rotation<T> whole;  ///< of itself and all above
    Vectors<T> position;
    Rotation<T> to_whole;
    Vectors<T> to_position;
};

template <typename T>
Vectors<T> offset_of(const RestSkeleton& skeleton, std::size_t joint) {
    const auto& offset = skeleton.offsets[joint];
    return {Lanes<T>{} + static_cast<T>(offset[0]), Lanes<T>{} + static_cast<T>(offset[1]),
            Lanes<T>{} + static_cast<T>(offset[2])};
}

/// Some frames of one person: a joint's six numbers, in rows (numbers, nodes, lanes).
template <typename T>
class Poses {
  public:
    Poses(T* rows, std::int64_t nodes) : rows_(rows), nodes_(nodes) {}

    Orthonormal<T> at(std::size_t joint) const { return {vectors(joint, 0), vectors(joint, axes)}; }
    void put(std::size_t joint, std::int64_t first, const Vectors<T>& v) {
        for (std::int64_t d = 0; d < axes; ++d) store(row(joint, first + d), v[d]);
    }

    /// From a motion's frames and back to them, `here` of them; `step` numbers lie between the six.
    void read(const T* motion, std::int64_t step, std::int64_t here) {
        for (std::int64_t d = 0; d < rotation_numbers; ++d)
            transpose(motion + d * step, nodes_, here, nodes_, row(0, d), lanes<T>);
    }
    void write(T* motion, std::int64_t step, std::int64_t here) const {
        for (std::int64_t d = 0; d < rotation_numbers; ++d)
            for (std::int64_t t = 0; t < here; ++t)
                for (std::int64_t k = 0; k < nodes_; ++k)
                    motion[d * step + t * nodes_ + k] = row(static_cast<std::size_t>(k), d)[t];
    }

  private:
    T* row(std::size_t joint, std::int64_t number) const {
        return rows_ + (number * nodes_ + static_cast<std::int64_t>(joint)) * lanes<T>;
    }
    Vectors<T> vectors(std::size_t joint, std::int64_t first) const {
        return {load(row(joint, first)), load(row(joint, first + 1)), load(row(joint, first + 2))};
    }

    T* rows_;
    std::int64_t nodes_;
};

template <typename T>
void turn_joints(const RestSkeleton& skeleton, const Poses<T>& poses, Turn<T>* turns) {
    for (const int joint : skeleton.order) {
        const auto j = static_cast<std::size_t>(joint);
        auto& turn = turns[j];
        const Rotation<T> own(poses.at(j));
        if (skeleton.parents[j] < 0) {
            turn.whole = own;
            turn.position = {};
            continue;
        }
        const auto& above = turns[skeleton.parents[j]];
        turn.whole = above.whole * own;
        turn.position = above.whole * offset_of<T>(skeleton, j);
        for (std::int64_t d = 0; d < axes; ++d) turn.position[d] += above.position[d];
    }
}

/// The squared differences' sum; gradients to `made`'s positions are their first, those to its rotations 0.
template <typename T>
Lanes<T> differences(Turn<T>* made, const Turn<T>* real, std::size_t joints) {
    Lanes<T> sum = {};
    for (std::size_t j = 0; j < joints; ++j) {
        made[j].to_whole = {};
        for (std::int64_t d = 0; d < axes; ++d) {
            const auto apart = made[j].position[d] - real[j].position[d];
            sum += apart * apart;
            made[j].to_position[d] = 2 * apart;
        }
    }
    return sum;
}

/// Gradients to the six numbers of a rotation, its third row being the first two's product.
template <typename T>
void put_gradient(const Orthonormal<T>& rows, const Rotation<T>& to_own, std::size_t joint, Poses<T>& to) {
    auto first = cross(rows.second(), to_own.row[2]), second = cross(to_own.row[2], rows.first());
    for (std::int64_t d = 0; d < axes; ++d) {
        first[d] += to_own.row[0][d];
        second[d] += to_own.row[1][d];
    }
    const auto back = rows.backward(first, second);
    to.put(joint, 0, back.a);
    to.put(joint, axes, back.b);
}

template <typename T>
void turn_joints_back(const RestSkeleton& skeleton, const Poses<T>& poses, Turn<T>* turns, Poses<T>& to) {
    for (auto joint = skeleton.order.rbegin(); joint != skeleton.order.rend(); ++joint) {
        const auto j = static_cast<std::size_t>(*joint);
        const auto& turn = turns[j];
        const auto rows = poses.at(j);
        if (skeleton.parents[j] < 0) {
            put_gradient(rows, turn.to_whole, j, to);
            continue;
        }
        auto& above = turns[skeleton.parents[j]];
        put_gradient(rows, above.whole.transposed() * turn.to_whole, j, to);
        above.to_whole += turn.to_whole * Rotation<T>(rows).transposed();
        const auto offset = offset_of<T>(skeleton, j);
        for (std::int64_t r = 0; r < axes; ++r) {
            above.to_position[r] += turn.to_position[r];
            for (std::int64_t c = 0; c < axes; ++c)
                above.to_whole.row[r][c] += turn.to_position[r] * offset[c];
        }
    }
}

/// Positions of a person's joints in `here` frames, (3, frames, joints) and `step` numbers between the axes.
template <typename T>
void write_positions(const Turn<T>* turns, std::int64_t joints, T* to, std::int64_t step, std::int64_t here) {
    for (std::int64_t d = 0; d < axes; ++d)
        for (std::int64_t t = 0; t < here; ++t)
            for (std::int64_t j = 0; j < joints; ++j) to[d * step + t * joints + j] = turns[j].position[d][t];
}

/// Gradients to them, the other way; those to whole rotations are 0, and so are those of the lanes behind `here`.
template <typename T>
void read_gradients(const T* from, std::int64_t joints, std::int64_t step, std::int64_t here,
                    Turn<T>* turns) {
    for (std::int64_t j = 0; j < joints; ++j) {
        turns[j].to_whole = {};
        turns[j].to_position = {};
        for (std::int64_t d = 0; d < axes; ++d)
            for (std::int64_t t = 0; t < here; ++t)
                turns[j].to_position[d][t] = from[d * step + t * joints + j];
    }
}

/// Some frames of a person at a time: where they begin, how many they are, their poses and scratch for their turns.
template <typename T, typename Do>
void by_frames(const RestSkeleton& skeleton, std::int64_t frames, const T* rotations, const Do& each) {
    const auto joints = static_cast<std::int64_t>(skeleton.parents.size()), nodes = joints + 1;
    Poses<T> poses(scratch<T>(MadeRows{}, rotation_numbers * nodes * lanes<T>), nodes);
    auto* turns = scratch<Turn<T>>(MadeTurns{}, static_cast<std::ptrdiff_t>(joints));
    for (std::int64_t t = 0; t < frames; t += lanes<T>) {
        const auto here = std::min<std::int64_t>(lanes<T>, frames - t);
        poses.read(rotations + t * nodes, frames * nodes, here);
        turn_joints(skeleton, poses, turns);
        each(t, here, poses, turns);
    }
}

/// All frames of one person: gradients to its rotations from those to its positions.
template <typename T>
void person_back(const RestSkeleton& skeleton, std::int64_t frames, const T* rotations, const T* to_positions,
                 T* to) {
    const auto joints = static_cast<std::int64_t>(skeleton.parents.size()), nodes = joints + 1;
    Poses<T> gradients(zeroed_scratch<T>(ToRows{}, rotation_numbers * nodes * lanes<T>), nodes);
    by_frames(skeleton, frames, rotations,
              [&](std::int64_t t, std::int64_t here, const auto& poses, auto* turns) {
                  read_gradients(to_positions + t * joints, joints, frames * joints, here, turns);
                  turn_joints_back(skeleton, poses, turns, gradients);
                  gradients.write(to + t * nodes, frames * nodes, here);
              });
}

/// All frames of one person: the squared differences' sum, and gradients to `made`.
template <typename T>
double person_differences(const RestSkeleton& skeleton, std::int64_t frames, const T* made, const T* real,
                          T* to) {
    const auto joints = skeleton.parents.size();
    const auto nodes = static_cast<std::int64_t>(joints) + 1, step = frames * nodes,
               count = rotation_numbers * nodes * lanes<T>;
    Poses<T> wanted(scratch<T>(RealRows{}, count), nodes),
        gradients(zeroed_scratch<T>(ToRows{}, count), nodes);
    auto* real_turns = scratch<Turn<T>>(RealTurns{}, static_cast<std::ptrdiff_t>(joints));
    double sum = 0;
    by_frames(skeleton, frames, made, [&](std::int64_t t, std::int64_t here, const auto& poses, auto* turns) {
        wanted.read(real + t * nodes, step, here);
        turn_joints(skeleton, wanted, real_turns);
        sum += static_cast<double>(sum_of(differences(turns, real_turns, joints)));
        turn_joints_back(skeleton, poses, turns, gradients);
        gradients.write(to + t * nodes, step, here);
    });
    return sum;
}

}  // namespace

template <typename T>
void forward_kinematics(const RestSkeleton& skeleton, const RotationsShape& shape, const T* rotations, T* to,
                        int threads) {
    const auto joints = static_cast<std::int64_t>(skeleton.parents.size()), frames = shape.frames;
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t i = 0; i < shape.samples * shape.persons; ++i)
        by_frames(skeleton, frames, rotations + i * rotation_numbers * frames * (joints + 1),
                  [&](std::int64_t t, std::int64_t here, const auto& /*poses*/, const auto* turns) {
                      write_positions(turns, joints, to + (i * axes * frames + t) * joints, frames * joints,
                                      here);
                  });
}

template <typename T>
void forward_kinematics_backward(const RestSkeleton& skeleton, const RotationsShape& shape,
                                 const T* rotations, const T* to_positions, T* to, int threads) {
    const auto joints = static_cast<std::int64_t>(skeleton.parents.size()),
               of_person = rotation_numbers * shape.frames * (joints + 1);
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t i = 0; i < shape.samples * shape.persons; ++i)
        person_back(skeleton, shape.frames, rotations + i * of_person,
                    to_positions + i * axes * shape.frames * joints, to + i * of_person);
}

template void forward_kinematics<float>(const RestSkeleton&, const RotationsShape&, const float*, float*,
                                        int);
template void forward_kinematics<double>(const RestSkeleton&, const RotationsShape&, const double*, double*,
                                         int);
template void forward_kinematics_backward<float>(const RestSkeleton&, const RotationsShape&, const float*,
                                                 const float*, float*, int);
template void forward_kinematics_backward<double>(const RestSkeleton&, const RotationsShape&, const double*,
                                                  const double*, double*, int);

template <typename T>
double joint_differences(const RestSkeleton& skeleton, const RotationsShape& shape, const T* made,
                         const T* real, T* to, int threads) {
    const auto size =
                   rotation_numbers * shape.frames * (static_cast<std::int64_t>(skeleton.parents.size()) + 1),
               all = shape.samples * shape.persons;
    std::vector<double> sums(static_cast<std::size_t>(all));
#pragma omp parallel for num_threads(threads) schedule(static)
    for (std::int64_t i = 0; i < all; ++i)
        sums[static_cast<std::size_t>(i)] =
            person_differences(skeleton, shape.frames, made + i * size, real + i * size, to + i * size);
    double sum = 0;
    for (const double one : sums) sum += one;
    return sum;
}

template double joint_differences<float>(const RestSkeleton&, const RotationsShape&, const float*,
                                         const float*, float*, int);
template double joint_differences<double>(const RestSkeleton&, const RotationsShape&, const double*,
                                          const double*, double*, int);

}  // namespace actformer::model::cpu
