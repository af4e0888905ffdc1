#ifndef DUET_CONTRIB_FORMATS_FBX_SCALE_INHERITANCE_H_
#define DUET_CONTRIB_FORMATS_FBX_SCALE_INHERITANCE_H_

#include <vector>

#include "contrib/formats/fbx/node_tree.h"
#include "model/retargeting/affine.h"

namespace duet::contrib::formats::fbx {

// Whether the product of local transforms gives each node's transform in the world: no node
// inherits its parent's scale otherwise, or no scale makes a difference.
//
// Shape of `locals` here and below: [nodes].
bool InheritsPlainly(const NodeTree& tree, const std::vector<retargeting::Affine>& locals);

// Returns local transforms whose products are at the places that Node::inherits defines, with
// tree.root applied to the roots. Scales are uniform: a product of others would shear.
//
// Source: FBX SDK, sample "Transformations", CalculateGlobalTransform.
std::vector<retargeting::Parts> InheritScales(const NodeTree& tree,
                                              const std::vector<retargeting::Affine>& locals);

}  // namespace duet::contrib::formats::fbx

#endif  // DUET_CONTRIB_FORMATS_FBX_SCALE_INHERITANCE_H_
