// node validate_gltf.js FILE.glb: what Khronos' gltf-validator has to say of it, one line an issue; nothing for a sound file.
const fs = require('fs');
const validator = require('gltf-validator');

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2]))).then((report) => {
    for (const issue of report.issues.messages)
        console.log(issue.severity, issue.code, issue.pointer || '', issue.message);
    if (report.issues.truncated) console.log('and more');
}, (error) => console.log('unreadable', error));
