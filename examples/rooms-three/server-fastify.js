import { resolve } from 'node:path';
import files from '@fastify/static';
import fastify from 'fastify';
import { attachRooms } from 'threepoint-relay';

const app = fastify().register(files, { root: resolve('dist') });
await app.listen({ port: process.env.PORT ?? 8080 });
attachRooms(app.server);
