import { builtRig } from './built-rig';
import { changed, type GltfJson } from './glb';

const rig = builtRig({ nameOf: (bone) => bone });
function nodesIn({ nodes }: GltfJson) {
  const nodeOf = (called: string): number => nodes.findIndex(({ name }) => name === called);
  return { body: nodeOf('Body'), head: nodeOf('head'), hand: nodeOf('leftHand') };
}

/** The bones of the rig, which are called as VRM 1.0 calls them. */
const bonesOf = (json: GltfJson): readonly (readonly [string, number])[] =>
  json.nodes.flatMap(({ name }, node) => (name === 'Armature' || name === 'Body' ? [] : [[name, node] as const]));

/**
 * VRM 1.0 with all that has numbers of nodes, meshes and materials in it: first person, an expression, springs,
 * colliders, a constraint.
 */
export const smallVrm = changed((json) => {
  const { body, head, hand } = nodesIn(json);
  json.extensionsUsed = ['VRMC_vrm', 'VRMC_springBone', 'VRMC_node_constraint', 'VRMC_materials_mtoon'];
  json.materials = [{ extensions: { VRMC_materials_mtoon: { specVersion: '1.0' } } }];
  for (const primitive of json.meshes[0]!.primitives) Object.assign(primitive, { material: 0 });
  Object.assign(json.nodes[hand]!, {
    extensions: { VRMC_node_constraint: { specVersion: '1.0', constraint: { rotation: { source: head } } } },
  });
  json.extensions = {
    VRMC_vrm: {
      specVersion: '1.0',
      meta: { name: 'small', authors: ['tests'], licenseUrl: 'https://vrm.dev/licenses/1.0/' },
      humanoid: { humanBones: Object.fromEntries(bonesOf(json).map(([bone, node]) => [bone, { node }])) },
      firstPerson: { meshAnnotations: [{ node: body, type: 'both' }] },
      expressions: {
        preset: { aa: { materialColorBinds: [{ material: 0, type: 'color', targetValue: [1, 1, 1, 1] }] } },
      },
      lookAt: { type: 'bone', offsetFromHeadBone: [0, 0, 0] },
    },
    VRMC_springBone: {
      specVersion: '1.0',
      colliders: [{ node: head, shape: { sphere: { offset: [0, 0, 0], radius: 0.1 } } }],
      colliderGroups: [{ colliders: [0] }],
      springs: [{ joints: [{ node: head, hitRadius: 0.02 }, { node: hand }], colliderGroups: [0], center: body }],
    },
  } as GltfJson['extensions'];
}, rig);

/** VRM 0.x with the same. */
export const smallOldVrm = changed((json) => {
  const { body, head, hand } = nodesIn(json);
  json.extensionsUsed = ['VRM'];
  json.materials = [{ name: 'skin' }];
  json.extensions = {
    VRM: {
      specVersion: '0.0',
      meta: { title: 'small', licenseName: 'CC0' },
      humanoid: { humanBones: bonesOf(json).map(([bone, node]) => ({ bone, node })) },
      firstPerson: { firstPersonBone: head, meshAnnotations: [{ mesh: 0, firstPersonFlag: 'Auto' }] },
      blendShapeMaster: {
        blendShapeGroups: [
          {
            ...{ name: 'A', presetName: 'a', binds: [] },
            materialValues: [{ materialName: 'skin', propertyName: '_Color', targetValue: [1, 1, 1, 1] }],
          },
        ],
      },
      secondaryAnimation: {
        boneGroups: [{ bones: [hand], center: body, colliderGroups: [0], hitRadius: 0.02 }],
        colliderGroups: [{ node: head, colliders: [{ offset: { x: 0, y: 0, z: 0 }, radius: 0.1 }] }],
      },
      materialProperties: [{ name: 'skin', shader: 'VRM_USE_GLTFSHADER', textureProperties: {}, floatProperties: {} }],
    },
  };
}, rig);
