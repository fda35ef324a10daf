// Insertion of a point: the tetrahedra round it give way to the cone from it.
//
// Idea (Klingner, Shewchuk 2007): the cavity starts with one tetrahedron, or with those round one of its
// edges, and grows across the face that makes the worst new tetrahedron while that helps; then the point
// moves to where the worst is best, and the cavity is grown once more. On the boundary the triangles that the
// point is put into give way to others from it; the cavity then has tetrahedra on both sides where solids
// meet. Postcondition: all tetrahedra have positive volume, whatever their angles (rescue.h sees to those);
// the point lies on its CAD face or edge, its triangles turn by less than 26 degrees and lie as close to the
// CAD as the old ones; no interior triangle with all corners on one CAD face appears.  Cost: 20 us.
#pragma once

#include "optimisation/edit_mesh.h"
#include "optimisation/smoothing.h"

namespace dm {

class Inserter {
 public:
  static constexpr int kPlaces = 11;

  Inserter(EditMesh& mesh, Smoother& smoother, const Geometry& geometry)
      : mesh_(mesh), smoother_(smoother), geometry_(geometry) {}

  // Puts a point, the last one of the mesh then, into a cavity with `tet`.  Place 0: inside; 1 to 6: on an
  // edge with both ends on the boundary (across a wall it is inside), the longest first; 7 to 10: on a
  // boundary triangle.  False when that is impossible.
  bool insert(Index tet, int place);
  // The corners of that edge or triangle, -1 for those missing; all -1 when there is none.
  Triangle site(Index tet, int place) const;

 private:
  struct Face {
    Index tet;
    int face;
    Triangle corners;
    double bad;  // of the tetrahedron from it to the point
  };
  bool insert_inside(Index tet);
  bool insert_on_edge(Index a, Index b);
  bool insert_on_triangle(Index tet, int face);
  bool list_edge(Index a, Index b);
  bool work_out();
  void start();
  void grow();
  bool cross(std::size_t worst);
  bool may_absorb(const Face& face);
  void add_face(Index tet, int face, std::vector<Face>& to) const;
  Index triangle_at(Index tet, int face);
  bool in_cavity(Index tet) const;
  void settle();
  bool is_valid() const;
  bool build_triangles();
  bool keeps_surface() const;
  bool keeps_surface(Index face) const;
  bool is_sound() const;
  bool drops_whole_points();
  bool is_rim(Index a, Index b) const;
  void commit();

  EditMesh& mesh_;
  Smoother& smoother_;
  const Geometry& geometry_;
  // The point: where, on what, between which ends of a segment, on which CAD faces.
  Vec3 place_;
  Entity entity_;
  Segment split_{-1, -1};
  std::vector<Index> on_faces_;
  // The cavity: its first tetrahedra and boundary triangles, all of them, the faces that the cone stands on.
  std::vector<Index> first_tets_, first_triangles_, cavity_, triangles_;
  std::vector<Face> faces_, fresh_;
  // What the boundary triangles become: two corners each, the third is the point.
  std::vector<Segment> rims_;
  std::vector<Index> rim_face_;
};

}  // namespace dm
