// What Khronos' validator finds in a glTF file, as JSON.
//   node validate.js FILE
const fs = require('fs');
const validator = require('gltf-validator');

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])), {maxIssues: 20})
    .then((report) => process.stdout.write(JSON.stringify(report)))
    .catch((error) => { process.stderr.write(`${error}\n`); process.exit(1); });
