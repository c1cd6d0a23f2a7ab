#include <doctest/doctest.h>

#include "polhode/math/detail/landen.hpp"

using namespace polhode::math;

namespace {

double relative_error(DD a, DD b) { return std::abs(((a - b) / b).hi); }

struct Case {
  DD k, kc, two_K_over_pi, nome;
  DD sn, cn, dn;        // at u = 2.6 K, so z = pi u / 2K = 1.3 pi
  DD im_sn, im_cn, im_dn, exp_minus;  // of modulus k' at K'/2
};

// mpmath at 60 digits
const Case cases[] = {
    {{0.5, 0.0}, {0.8660254037844386, 5.0175421109034514e-17},
     {1.0731820071493643, 8.297715335388142e-17}, {0.01797238700896724, 4.632246089277578e-19},
     {-0.8285204148264069, 2.876900232219994e-17}, {-0.5599588576099843, 5.0979513029674245e-17},
     {0.9101584919968443, -4.7812143486896585e-18},
     {0.816496580927726, -1.7276510382355637e-18}, {0.5773502691896257, 3.3450280739356345e-17},
     {0.7071067811865476, -4.833646656726457e-17}, {0.3661435942516845, 1.9932700013428608e-17}},
    {{0.9848857801796105, -2.296305974143869e-17}, {0.1732050807568878, -7.415365415988862e-18},
     {2.009092390947456, -4.560360225219663e-18}, {0.20687981084784157, -7.56245945694266e-18},
     {-0.9614162995527213, -4.1400666867985475e-17}, {-0.2750976171368118, -2.488413504736437e-17},
     {0.3215716685059823, 1.471285946135386e-17},
     {0.7097938625730132, -1.115846577036476e-17}, {0.7044094495772203, -3.91777899133926e-17},
     {0.9924141172814958, 2.3164813888602974e-17}, {0.6744185818154789, -2.4884227531259855e-17}},
    {{9.094947017729282e-13, 0.0}, {1.0, -4.1359030627651384e-25},
     {1.0, 2.0679515313825692e-25}, {5.169878828456423e-26, 2.1382117680737565e-50},
     {-0.8090169943749475, 2.7160575960611527e-17}, {-0.5877852522924731, 7.934750917746274e-18},
     {1.0, -2.7069836981234805e-25},
     {0.9999999999995453, 3.101927297071503e-25}, {9.536743164058163e-07, 2.958228394576552e-31},
     {9.5367431640625e-07, -1.4836824602749686e-67}, {4.76837158203125e-07, 4.930380657631324e-32}},
};

}  // namespace

TEST_CASE("the Landen chain gives K, the nome and both descents to double-double accuracy") {
  for (const Case& c : cases) {
    const LandenChain<DD> chain(c.k, c.kc);
    CHECK(relative_error(chain.two_K_over_pi(), c.two_K_over_pi) < 1e-30);
    CHECK(relative_error(chain.nome(), c.nome) < 4e-30);

    const auto real = descend_real(chain, c.sn, c.cn, DD(1.0), c.dn);
    const DD z = atan2(real.Y, real.X) + scaled(pi<DD>(), 2.0);
    CHECK(relative_error(z, pi<DD>() * DD(13.0) / DD(10.0)) < 1e-30);

    const auto imaginary = descend_imaginary(chain, c.im_sn, c.im_cn, c.im_dn);
    CHECK(relative_error(imaginary.exp_minus(), c.exp_minus) < 1e-30);
    CHECK(relative_error(imaginary.H * imaginary.H, imaginary.P * imaginary.P + imaginary.Q * imaginary.Q) < 1e-30);
  }
}

TEST_CASE("a chain with its descent beside it agrees with both, at any argument") {
  for (const Case& c : cases) {
    const ImaginaryChain<double> both(c.k, c.kc, c.im_sn, c.im_cn, c.im_dn);
    CHECK(relative_error(both.two_K_over_pi, c.two_K_over_pi) < 1e-30);
    CHECK(relative_error(both.chain.nome(), c.nome) < 4e-30);
    CHECK(relative_error(both.end.exp_minus(), c.exp_minus) < 1e-30);
  }
  // cn from 1 down to where k sn / cn is huge: a body whose two larger moments are nearly equal starts there.
  for (double k2 = 0.97; k2 > 1e-20; k2 *= 0.6) {
    const DD kc = sqrt(DD(1.0) - DD(k2)), k = sqrt(DD(k2));
    const LandenChain<DD> chain(k, kc);
    for (double cn = 1.0; cn > 1e-18; cn *= 0.3) {
      const DD sn = sqrt((DD(1.0) - DD(cn)) * (DD(1.0) + DD(cn))), dn = sqrt(DD(cn) * DD(cn) + DD(k2) * sn * sn);
      const ImaginaryChain<double> both(k, kc, sn, DD(cn), dn);
      CHECK(relative_error(both.two_K_over_pi, chain.two_K_over_pi()) < 1e-30);
      CHECK(relative_error(both.end.exp_minus(), descend_imaginary(chain, sn, DD(cn), dn).exp_minus()) < 1e-29);
    }
  }
}

TEST_CASE("the same chain in double is right to a few ulp") {
  for (const Case& c : cases) {
    const LandenChain<double> chain(c.k.hi, c.kc.hi);
    CHECK(chain.two_K_over_pi() == doctest::Approx(c.two_K_over_pi.hi).epsilon(4e-16));
    CHECK(chain.nome() == doctest::Approx(c.nome.hi).epsilon(2e-15));
    const auto imaginary = descend_imaginary(chain, c.im_sn.hi, c.im_cn.hi, c.im_dn.hi);
    CHECK(imaginary.exp_minus() == doctest::Approx(c.exp_minus.hi).epsilon(1e-15));
  }
}

TEST_CASE("a nome far below the square root of the smallest double keeps its digits") {
  // q = k^2 / 16 (1 + ...), k = 2^-500
  CHECK(LandenChain<double>(0x1p-500, 1.0).nome() == doctest::Approx(0x1p-1004).epsilon(1e-15));
}
