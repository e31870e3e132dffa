// Contact laws: h'' + alpha1 h' + alpha0 h + alpha3 h^3 = 0 while a contact is active, and what they mean for an impact.
//
// A linear law beta1 = 2 zeta w, beta0 = w^2 released at h'' = 0 gives the restitution e(zeta); users state e and a contact time.
//
//     e   = exp(-2 zeta acos(zeta) / sqrt(1 - zeta^2))    zeta < 1;    e^-2 at 1;    the same with acosh and sqrt(zeta^2 - 1) above (12)
//     t_c = 2 acos(zeta) / (w sqrt(1 - zeta^2)) (13)
#pragma once

namespace tenon::contact {

/// Numbers of one law: alpha0 1/s^2, alpha1 1/s, alpha3 1/(m^2 s^2). It prescribes h'', so it is independent of mass.
struct Law {
  double alpha0 = 0, alpha1 = 0, alpha3 = 0;

  /// The h'' that the law asks for.
  double acceleration(double h, double hdot) const { return -(alpha1 * hdot + alpha0 * h + alpha3 * h * h * h); }

  /// Both poles at -p.
  static Law critical(double p) { return {p * p, 2 * p, 0}; }
};

/// e of a linear law with damping ratio zeta >= 0.  (12)
double restitution_of(double zeta);
/// zeta for a restitution in (0, 1]; e = 0 has none, any law of large zeta is near it.
double damping_ratio_of(double restitution);
/// w^2 and 2 zeta w of a collision with this restitution in (0, 1] that lasts contact_time > 0 s.  (13)
Law law_of(double restitution, double contact_time);
/// From the first touch at this closing speed to release, s.  (13)
double contact_time_of(const Law& law);

}  // namespace tenon::contact
