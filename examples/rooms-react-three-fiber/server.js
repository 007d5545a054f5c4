import express from 'express';
import { attachRooms } from 'threepoint-relay';

const app = express().use(express.static('dist'));
attachRooms(app.listen(process.env.PORT ?? 8080));
