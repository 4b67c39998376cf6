#include "scintray/core/plain_vec.hpp"

#include <doctest/doctest.h>

#include "scintray/core/function_ref.hpp"

using namespace scintray;
using namespace scintray::core;

TEST_CASE("Plain vectors calculate as Eigen's do") {
  const Vec3 a(0.1, -2.7, 3.3), b(1.9, 0.4, -0.6);
  PlainVec3 p = a;
  const PlainVec3 q = b;
  CHECK(Vec3(p + q) == Vec3(a + b));
  CHECK(Vec3(p - b) == Vec3(a - b));
  CHECK(Vec3(a - q) == Vec3(a - b));
  CHECK(Vec3(-p) == Vec3(-a));
  CHECK(Vec3(2.5 * p) == Vec3(2.5 * a));
  CHECK(p.dot(q) == a.dot(b));
  CHECK(p.cross(b) == a.cross(b));
  CHECK(p.normalized() == a.normalized());
  p += 0.3 * q;
  CHECK(p.vec() == Vec3(a + 0.3 * b));
  p.normalize();
  CHECK(p == PlainVec3((a + 0.3 * b).normalized()));
  p.z() = 4.0;
  CHECK(p[2] == 4.0);
}

TEST_CASE("A plain matrix is the matrix that it was made from") {
  Eigen::Matrix3d m;
  m << 1, 2, 3, 4, 5, 6, 7, 8, 10;
  const PlainMatrix3 plain = m;
  CHECK(plain.matrix() == m);
  CHECK(plain.row(1) == Vec3(4, 5, 6));
  CHECK(plain.column(2) == PlainVec3(3, 6, 10));
  CHECK(PlainMatrix3::identity().matrix().isIdentity(0.0));
}

TEST_CASE("A function reference calls what it refers to") {
  int calls = 0;
  const auto add = [&](int n) { return calls += n; };
  const FunctionRef<int(int)> reference = add;
  CHECK(reference);
  CHECK(reference(2) == 2);
  const FunctionRef<int(int)> copy = reference;
  CHECK(copy(3) == 5);
  CHECK_FALSE(FunctionRef<int(int)>());
}
