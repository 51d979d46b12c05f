// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <fstream>
#include <string>
#include <vector>

#ifdef VERNIER_WITH_EIGEN
#include <Eigen/Geometry>
#endif
#ifdef VERNIER_WITH_KDL
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#endif

namespace vernier::bench {

/// One transform of the chain with its degrees of freedom evaluated: mm and rad, X Y Z rX rY rZ, or theta d a
/// alpha.
struct Link {
  bool dh = false;
  double dof[6] = {};
};

/// Both branches of a machine at one pose. The peers multiply its frames out, sines and cosines included;
/// expressions and tables are already evaluated for them, and a deviation would need the nominal chain too.
struct Chain {
  std::vector<Link> workpiece, tool;
};

/// chain.txt of bench_generate, one Chain a pose.
inline std::vector<Chain> read_chains(const std::string& path) {
  constexpr double kRad = 0.017453292519943295;
  std::ifstream file(path);
  std::size_t poses = 0, axes = 0, workpiece = 0, tool = 0;
  file >> poses >> axes >> workpiece >> tool;
  for (std::size_t i = 0; i < axes; ++i) {
    int rotary = 0;
    file >> rotary;
  }
  std::vector<Chain> chains(poses);
  for (std::size_t t = 0; t < workpiece + tool; ++t) {
    std::string kind;
    file >> kind;
    const bool dh = kind == "DH";
    std::vector<Link> links(poses);
    for (std::size_t d = 0; d < (dh ? 4u : 6u); ++d) {
      const bool angle = dh ? d == 0 || d == 3 : d >= 3;
      for (Link& link : links) {
        file >> link.dof[d];
        if (angle) link.dof[d] *= kRad;
        link.dh = dh;
      }
    }
    for (std::size_t p = 0; p < poses; ++p)
      (t < workpiece ? chains[p].workpiece : chains[p].tool).push_back(links[p]);
  }
  return chains;
}

#ifdef VERNIER_WITH_EIGEN
inline Eigen::Isometry3d eigen_frame(const Link& l) {
  using Eigen::AngleAxisd, Eigen::Translation3d, Eigen::Vector3d;
  if (l.dh)
    return Translation3d(0, 0, l.dof[1]) * AngleAxisd(l.dof[0], Vector3d::UnitZ()) *
           Translation3d(l.dof[2], 0, 0) * AngleAxisd(l.dof[3], Vector3d::UnitX());
  return Translation3d(l.dof[0], l.dof[1], l.dof[2]) * AngleAxisd(l.dof[3], Vector3d::UnitX()) *
         AngleAxisd(l.dof[4], Vector3d::UnitY()) * AngleAxisd(l.dof[5], Vector3d::UnitZ());
}

/// W^-1 * T * origin.
inline Eigen::Vector3d eigen_chain(const Chain& chain) {
  Eigen::Isometry3d w = Eigen::Isometry3d::Identity(), t = w;
  for (const Link& l : chain.workpiece) w = w * eigen_frame(l);
  for (const Link& l : chain.tool) t = t * eigen_frame(l);
  return w.inverse() * t.translation();
}
#endif

#ifdef VERNIER_WITH_KDL
inline KDL::Frame kdl_frame(const Link& l) {
  if (l.dh) return KDL::Frame::DH(l.dof[2], l.dof[3], l.dof[1], l.dof[0]);
  return KDL::Frame(
      KDL::Rotation::RotX(l.dof[3]) * KDL::Rotation::RotY(l.dof[4]) * KDL::Rotation::RotZ(l.dof[5]),
      KDL::Vector(l.dof[0], l.dof[1], l.dof[2]));
}

inline KDL::Vector kdl_chain(const Chain& chain) {
  KDL::Frame w = KDL::Frame::Identity(), t = w;
  for (const Link& l : chain.workpiece) w = w * kdl_frame(l);
  for (const Link& l : chain.tool) t = t * kdl_frame(l);
  return w.Inverse() * t.p;
}
#endif

}  // namespace vernier::bench
