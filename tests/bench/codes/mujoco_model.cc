// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/codes/mujoco_model.h"

#include <iomanip>
#include <sstream>

namespace bench {

namespace {

std::string vector_text(const Eigen::Vector3d& v) {
  std::ostringstream text;
  text << std::setprecision(17) << v[0] << ' ' << v[1] << ' ' << v[2];
  return text.str();
}

class MjcfWriter {
 public:
  explicit MjcfWriter(const PlainLinkage& linkage) : linkage_(linkage) { out_ << std::setprecision(17); }

  std::string write(const char* integrator, double step) {
    out_ << "<mujoco><compiler angle=\"radian\"/><option timestep=\"" << step << "\" integrator=\""
         << integrator << "\" gravity=\"" << vector_text(linkage_.gravity_W) << "\">"
         << (linkage_.loops.empty() ? "<flag constraint=\"disable\"/>" : "") << "</option><worldbody>";
    add_children(-1);
    out_ << "</worldbody><equality>";
    for (const PlainLoop& loop : linkage_.loops) add_loop(loop, step);
    out_ << "</equality><actuator>";
    for (int i = 0; linkage_.forces && i < linkage_.forces->bristle_count(); ++i)
      out_ << "<general joint=\"" << linkage_.bodies[0].joint[0].name
           << "\" dyntype=\"user\" gainprm=\"0\"/>";
    out_ << "</actuator></mujoco>";
    return out_.str();
  }

 private:
  void add_children(int parent) {
    for (std::size_t i = 0; i < linkage_.bodies.size(); ++i)
      if (linkage_.bodies[i].parent == parent) add_body(static_cast<int>(i));
  }

  void add_body(int i) {
    const PlainBody& body = linkage_.bodies[static_cast<std::size_t>(i)];
    out_ << "<body name=\"" << i << "\" pos=\"" << vector_text(body.p_PJ) << "\">";
    for (const PlainCoordinate& c : body.joint) add_joint(c);
    add_inertia(body);
    add_children(i);
    out_ << "</body>";
  }

  /// As stiff as MuJoCo's soft constraints get at this step.
  void add_loop(const PlainLoop& loop, double step) {
    out_ << "<connect body1=\"" << loop.bodies[0] << "\" body2=\"" << loop.bodies[1] << "\" anchor=\""
         << vector_text(loop.points[0]) << "\" solref=\"" << 2.0 * step
         << " 1\" solimp=\"0.9999 0.9999 0.001\"/>";
  }

  void add_joint(const PlainCoordinate& c) {
    out_ << "<joint name=\"" << c.name << "\" type=\"" << (c.slides ? "slide" : "hinge") << "\" axis=\""
         << vector_text(Eigen::Vector3d::Unit(c.axis)) << "\" stiffness=\"" << c.stiffness << "\" damping=\""
         << c.damping << "\" armature=\"" << (c.drive ? kDrivenArmature : 0.0) << "\"/>";
  }

  /// MuJoCo has moments about the centre of mass, which lies on a principal axis.
  void add_inertia(const PlainBody& body) {
    const Eigen::Vector3d square = body.com.cwiseAbs2();
    const Eigen::Vector3d central = body.inertia - body.mass * (square.sum() - square.array()).matrix();
    out_ << "<inertial pos=\"" << vector_text(body.com) << "\" mass=\"" << body.mass << "\" diaginertia=\""
         << vector_text(central) << "\"/>";
  }

  const PlainLinkage& linkage_;
  std::ostringstream out_;
};

}  // namespace

std::string write_mjcf(const PlainLinkage& linkage, const char* integrator, double step) {
  return MjcfWriter(linkage).write(integrator, step);
}

}  // namespace bench
